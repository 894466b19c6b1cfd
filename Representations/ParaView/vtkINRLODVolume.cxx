// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRLODVolume.h"

#include "SharedDrawing.h"
#include "vtkINRVolumeMapper.h"
#include "vtkInformation.h"
#include "vtkInformationObjectBaseVectorKey.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderPass.h"
#include "vtkRenderer.h"

vtkStandardNewMacro(vtkINRLODVolume);

namespace {

vtkMTimeType LatestShown = 0;

} // namespace

vtkMTimeType vtkINRLODVolume::GetLatestShownMTime() { return LatestShown; }

namespace {

bool IsPeeling(vtkInformation* keys)
{
  return keys && keys->Has(vtkOpenGLRenderPass::RenderPasses());
}

} // namespace

int vtkINRLODVolume::RenderVolumetricGeometry(vtkViewport* viewport)
{
  this->DrawInOverlay = IsPeeling(this->GetPropertyKeys());
  return this->DrawInOverlay ? 0 : this->Draw(viewport);
}

int vtkINRLODVolume::RenderOverlay(vtkViewport* viewport)
{
  if (!this->DrawInOverlay) {
    return 0;
  }
  this->DrawInOverlay = false;
  return this->Draw(viewport);
}

void vtkINRLODVolume::Show(bool here)
{
  this->DrawnHere = here;
  this->Shown.Modified();
  LatestShown = this->Shown.GetMTime();
}

int vtkINRLODVolume::Draw(vtkViewport* viewport)
{
  this->Drawn.Modified();
  if (this->Withheld) {
    return 0;
  }
  auto* renderer = vtkRenderer::SafeDownCast(viewport);
  auto* mapper = vtkINRVolumeMapper::SafeDownCast(this->GetMapper());
  if (renderer && mapper && mapper->GetDrawsTogether()) {
    mapper->SetProcessOrder(inr::ProcessOrder(renderer));
  }
  return this->Superclass::RenderVolumetricGeometry(viewport);
}

void vtkINRLODVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "DrawInOverlay: " << this->DrawInOverlay << "\n";
}
