// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRStatusActor.h"

#include "FrameStatus.h"
#include "SharedDrawing.h"
#include "vtkINRLODVolume.h"
#include "vtkINRVolumeMapper.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTextProperty.h"
#include "vtkViewport.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <locale>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkINRStatusActor);

namespace {

constexpr double Margin = 8; // pixels
constexpr int LargestFont = 14;
constexpr int SmallestFont = 7; ///< that can be read

std::string NameOf(vtkINRVolumeMapper* mapper)
{
  const char* array = mapper->GetArrayName();
  return array && *array ? array : "volume";
}

std::string LevelsOf(const inr::FrameStatus& status)
{
  if (status.finest < 0) {
    return status.samples > 0 ? "straight from the network" : "nothing visible";
  }
  const std::string first = std::to_string(status.finest);
  return status.finest == status.coarsest
             ? "level " + first
             : "levels " + first + " to " + std::to_string(status.coarsest);
}

std::string ProgressOf(const inr::FrameStatus& status, vtkINRVolumeMapper* mapper)
{
  // Rounded down: 100 % means all, of those that were taken for the picture that is shown.
  const int percent = static_cast<int>(std::floor(100 * status.hitRate));
  std::string text = std::to_string(percent) + " % there";
  if (mapper->GetRenderMode() == vtkINRVolumeMapper::PATH_TRACING) {
    text += ", " + std::to_string(static_cast<std::int64_t>(status.paths)) + " of " +
            std::to_string(mapper->GetSamplesPerPixel()) + " paths";
  }
  if (status.reduction > 1) {
    text += ", 1 of " + std::to_string(status.reduction * status.reduction) + " pixels";
  }
  return text + (status.converged ? "" : " ...");
}

/// What of a picture differs from the cached voxels, because ranges of its macro-cells do not hold;
/// rounded up, so that nothing is said where nothing does. Straight from the network there are
/// values between voxels outside of all ranges that do hold.
std::string ClampedOf(const inr::FrameStatus& status)
{
  if (status.clamped <= 0 || status.finest < 0) {
    return {};
  }
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(2)
       << std::min(100.0, std::ceil(1e4 * status.clamped / status.samples) / 100)
       << " % moved into range, ";
  return text.str();
}

/// Whether the picture is part of a larger one, of which each part has a status of its own.
bool IsTile(vtkViewport* viewport)
{
  const int* scale = viewport->GetVTKWindow()->GetTileScale();
  return scale[0] > 1 || scale[1] > 1;
}

} // namespace

vtkINRStatusActor::vtkINRStatusActor()
{
  vtkTextProperty* style = this->GetTextProperty();
  style->SetFontFamilyToCourier();
  style->SetFontSize(LargestFont);
  style->SetColor(1, 1, 1);
  style->SetBackgroundColor(0, 0, 0); // legible whatever is behind it
  style->SetBackgroundOpacity(0.5);
  style->SetVerticalJustificationToTop();
  this->PickableOff();
}

void vtkINRStatusActor::SetVolume(vtkINRLODVolume* volume, vtkINRVolumeMapper* mapper)
{
  this->StatusVolume = volume;
  this->StatusMapper = mapper;
}

std::string vtkINRStatusActor::GetText()
{
  vtkINRVolumeMapper* mapper = this->StatusMapper;
  if (!mapper) {
    return {};
  }
  return this->StatusVolume->GetOutOfSight() ? NameOf(mapper) + ": out of sight"
                                             : this->TextOf(inr::StatusOf(mapper));
}

std::string vtkINRStatusActor::TextOf(const inr::FrameStatus& status)
{
  vtkINRVolumeMapper* mapper = this->StatusMapper;
  if (!status.drawn) {
    return {};
  }
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << NameOf(mapper) << ": " << LevelsOf(status) << ", "
       << ProgressOf(status, mapper) << "\n";
  text << ClampedOf(status) << "cache " << std::setprecision(0) << status.cacheMiB << " MiB, ";
  if (status.processes > 1) {
    text << status.processes << " x ";
  }
  text << mapper->GetBackendInUse() << ", " << 1000 * status.seconds << " ms";
  return text.str();
}

std::string vtkINRStatusActor::TextIn(vtkViewport* viewport)
{
  if (!this->Processes) {
    return this->GetText();
  }
  vtkRenderer* renderer = vtkRenderer::SafeDownCast(viewport);
  const std::vector<int> order = renderer ? inr::ProcessOrder(renderer) : std::vector<int>();
  if (order.empty() || !this->StatusMapper) { // in all processes alike
    return {};
  }
  const inr::FrameStatus status =
      inr::StatusOfAll(inr::StatusOf(this->StatusMapper), this->Processes);
  return order.front() == this->Processes->GetLocalProcessId() ? this->TextOf(status)
                                                               : std::string();
}

void vtkINRStatusActor::SetProcesses(vtkMultiProcessController* processes, vtkRenderWindow* window)
{
  this->Processes = processes;
  this->Window = window;
}

double* vtkINRStatusActor::GetBounds()
{
  // Of a process' picture only that part is composed which these are seen in.
  const bool isComposed = this->Processes && this->Window && this->Window->CheckInRenderStatus();
  return isComposed ? this->Everywhere : this->Superclass::GetBounds();
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

void vtkINRStatusActor::FitInto(vtkViewport* viewport)
{
  vtkTextProperty* style = this->GetTextProperty();
  const double room = viewport->GetSize()[0] - 2 * Margin;
  const auto width = [&] {
    double size[2];
    this->GetSize(viewport, size);
    return std::max(size[0], 1.0);
  };
  const int now = style->GetFontSize();
  const double fitting = std::floor(now * room / width());
  const int wanted = static_cast<int>(std::clamp<double>(fitting, SmallestFont, LargestFont));
  // Widths are rounded by the letter: a step up is left for where there is room for two, and a step
  // down may not be enough.
  if (wanted < now || wanted > now + 1 || wanted == LargestFont) {
    style->SetFontSize(wanted);
  }
  while (style->GetFontSize() > SmallestFont && width() > room) {
    style->SetFontSize(style->GetFontSize() - 1);
  }
}

int vtkINRStatusActor::RenderOverlay(vtkViewport* viewport)
{
  const std::string text = this->TextIn(viewport);
  this->Height = 0;
  if (text.empty() || IsTile(viewport)) {
    return 0;
  }
  this->SetInput(text.c_str());
  this->FitInto(viewport);
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
