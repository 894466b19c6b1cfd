// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRStatusActor.h"

#include "vtkINRVolumeMapper.h"
#include "vtkObjectFactory.h"
#include "vtkPropCollection.h"
#include "vtkTextProperty.h"
#include "vtkViewport.h"

#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

vtkStandardNewMacro(vtkINRStatusActor);

namespace {

constexpr double Margin = 8; // pixels

std::string LevelsOf(const vtkINRVolumeMapper* mapper)
{
  const int finest = mapper->GetFinestLevel();
  const int coarsest = mapper->GetCoarsestLevel();
  if (finest < 0) {
    return mapper->GetNumberOfSamples() == 0 ? "nothing visible" : "straight from the network";
  }
  const std::string first = std::to_string(finest);
  return finest == coarsest ? "level " + first
                            : "levels " + first + " to " + std::to_string(coarsest);
}

std::string ProgressOf(vtkINRVolumeMapper* mapper)
{
  // Rounded down: 100 % means all.
  const int percent = static_cast<int>(std::floor(100 * mapper->GetCacheHitRate()));
  std::string text = std::to_string(percent) + " % there";
  if (mapper->GetRenderMode() == vtkINRVolumeMapper::PATH_TRACING) {
    text += ", " + std::to_string(mapper->GetNumberOfPaths()) + " of " +
            std::to_string(mapper->GetSamplesPerPixel()) + " paths";
  }
  return text + (mapper->GetConverged() ? "" : " ...");
}

} // namespace

vtkINRStatusActor::vtkINRStatusActor()
{
  vtkTextProperty* style = this->GetTextProperty();
  style->SetFontFamilyToCourier();
  style->SetFontSize(14);
  style->SetColor(1, 1, 1);
  style->SetBackgroundColor(0, 0, 0); // legible whatever is behind it
  style->SetBackgroundOpacity(0.5);
  style->SetVerticalJustificationToTop();
  this->PickableOff();
}

std::string vtkINRStatusActor::GetText()
{
  vtkINRVolumeMapper* mapper = this->StatusMapper;
  if (!mapper || mapper->GetImageReduction() == 0) {
    return {};
  }
  const char* array = mapper->GetArrayName();
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << (array && *array ? array : "volume") << ": " << LevelsOf(mapper) << ", "
       << ProgressOf(mapper) << "\n";
  text << "cache " << std::setprecision(0) << mapper->GetCacheUsed() << " MiB, "
       << mapper->GetBackendInUse() << ", " << 1000 * mapper->GetFrameTime() << " ms";
  return text.str();
}

double vtkINRStatusActor::TopIn(vtkViewport* viewport)
{
  double top = viewport->GetSize()[1] - Margin;
  vtkPropCollection* props = viewport->GetViewProps();
  vtkCollectionSimpleIterator place;
  props->InitTraversal(place);
  while (vtkProp* prop = props->GetNextProp(place)) {
    auto* other = vtkINRStatusActor::SafeDownCast(prop);
    if (other == this) {
      break;
    }
    if (other && other->GetVisibility()) {
      top -= other->Height;
    }
  }
  return top;
}

int vtkINRStatusActor::RenderOverlay(vtkViewport* viewport)
{
  const std::string text = this->GetText();
  this->Height = 0;
  if (text.empty()) {
    return 0;
  }
  this->SetInput(text.c_str());
  this->SetPosition(Margin, this->TopIn(viewport));
  double size[2];
  this->GetSize(viewport, size);
  this->Height = size[1] + Margin / 2;
  this->UpdateRectangle(viewport);
  return this->Superclass::RenderOverlay(viewport);
}

void vtkINRStatusActor::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Text: " << this->GetText() << "\n";
}
