// SPDX-License-Identifier: BSD-3-Clause
#include "SharedDrawing.h"

#include "vtkCameraPass.h"
#include "vtkCommunicator.h"
#include "vtkINRLODVolume.h"
#include "vtkIceTCompositePass.h"
#include "vtkImageProcessingPass.h"
#include "vtkMultiProcessController.h"
#include "vtkOrderedCompositingHelper.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeCollection.h"

#include <vector>

namespace inr {

namespace {

/// What composes the pictures that the processes make of a renderer; null where nothing does.
vtkIceTCompositePass* CompositePassOf(vtkRenderer* renderer)
{
  vtkRenderPass* pass = renderer->GetPass();
  while (pass) {
    if (auto* found = vtkIceTCompositePass::SafeDownCast(pass)) {
      return found;
    }
    auto* camera = vtkCameraPass::SafeDownCast(pass);
    auto* processing = vtkImageProcessingPass::SafeDownCast(pass);
    pass = camera       ? camera->GetDelegatePass()
           : processing ? processing->GetDelegatePass()
                        : nullptr;
  }
  return nullptr;
}

bool IsOnePicture(vtkIceTCompositePass* pass)
{
  const int* tiles = pass->GetTileDimensions();
  return tiles[0] == 1 && tiles[1] == 1 && !pass->GetDataReplicatedOnAllProcesses();
}

} // namespace

void DrawEverywhere(vtkRenderer* renderer)
{
  if (vtkIceTCompositePass* pass = CompositePassOf(renderer)) {
    pass->RenderEmptyImagesOn();
  }
}

int FrontProcess(vtkRenderer* renderer)
{
  vtkIceTCompositePass* pass = CompositePassOf(renderer);
  if (!pass || !pass->GetUseOrderedCompositing() || !pass->GetOrderedCompositingHelper() ||
      !pass->GetRenderEmptyImages() || !IsOnePicture(pass)) {
    return -1;
  }
  const std::vector<int> order =
      pass->GetOrderedCompositingHelper()->ComputeSortOrder(renderer->GetActiveCamera());
  vtkMultiProcessController* processes = pass->GetController();
  const bool isOfAll =
      processes && static_cast<int>(order.size()) == processes->GetNumberOfProcesses();
  return isOfAll ? order.front() : -1;
}

std::vector<vtkVolume*> ShownVolumes(vtkRenderer* renderer)
{
  std::vector<vtkVolume*> shown;
  vtkCollectionSimpleIterator place;
  vtkVolumeCollection* volumes = renderer->GetVolumes();
  volumes->InitTraversal(place);
  while (vtkVolume* volume = volumes->GetNextVolume(place)) {
    if (volume->GetVisibility() != 0 && vtkINRLODVolume::SafeDownCast(volume)) {
      shown.push_back(volume);
    }
  }
  return shown;
}

bool AllHave(vtkMultiProcessController* processes, bool something)
{
  const int mine = something ? 1 : 0;
  int least = mine;
  if (processes && processes->GetNumberOfProcesses() > 1) {
    processes->AllReduce(&mine, &least, 1, vtkCommunicator::MIN_OP);
  }
  return least > 0;
}

} // namespace inr
