// SPDX-License-Identifier: BSD-3-Clause
#include "SharedDrawing.h"

#include "Core/Model/Model.h"
#include "Core/Model/ModelBlobs.h"
#include "Readers/Common/Processes.h"
#include "vtkCameraPass.h"
#include "vtkCommunicator.h"
#include "vtkDataSet.h"
#include "vtkINRDataArray.h"
#include "vtkINRLODVolume.h"
#include "vtkIceTCompositePass.h"
#include "vtkImageData.h"
#include "vtkImageProcessingPass.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkOrderedCompositingHelper.h"
#include "vtkPointData.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeCollection.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
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

/// That array if it is of a model, or else the first one that is; null for none.
const vtkINRDataArray* FindModelArray(vtkPointData* points, const char* name)
{
  const auto* named =
      vtkINRDataArray::SafeDownCast(name ? points->GetAbstractArray(name) : nullptr);
  return named ? named : vtkINRDataArray::SafeDownCast(vtkINRDataArray::FindIn(points));
}

/// What equal models have in common and others have not, but for very few; 0 of none.
std::uint32_t ChecksumOf(const vtkINRDataArray* array)
{
  if (!array || !array->GetModel()) {
    return 0;
  }
  constexpr std::size_t most = 4096; // parameters, evenly: no more than a millisecond of a model
  const Model& model = *array->GetModel();
  const VolumeInfo& volume = model.volume;
  const double range[] = {volume.low, volume.high};
  std::uint32_t sum = ContinueChecksum(0, &volume.dims, sizeof(volume.dims));
  sum = ContinueChecksum(sum, &volume.spacing, sizeof(volume.spacing));
  sum = ContinueChecksum(sum, &volume.origin, sizeof(volume.origin));
  sum = ContinueChecksum(sum, &volume.direction, sizeof(volume.direction));
  sum = ContinueChecksum(sum, range, sizeof(range));
  sum = ContinueChecksum(sum, volume.arrayName.data(), volume.arrayName.size());
  const std::size_t stride = model.parameters.size() / most + 1;
  for (std::size_t k = 0; k < model.parameters.size(); k += stride) {
    sum = ContinueChecksum(sum, &model.parameters[k], sizeof(float));
  }
  return sum;
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

std::vector<int> ProcessOrder(vtkRenderer* renderer)
{
  vtkIceTCompositePass* pass = CompositePassOf(renderer);
  if (!pass || !pass->GetUseOrderedCompositing() || !pass->GetOrderedCompositingHelper() ||
      !pass->GetRenderEmptyImages() || !IsOnePicture(pass)) {
    return {};
  }
  const std::vector<int> order =
      pass->GetOrderedCompositingHelper()->ComputeSortOrder(renderer->GetActiveCamera());
  vtkMultiProcessController* processes = pass->GetController();
  const bool isOfAll =
      processes && static_cast<int>(order.size()) == processes->GetNumberOfProcesses();
  return isOfAll ? order : std::vector<int>();
}

bool HasSize(vtkVolume* volume)
{
  return std::abs(volume->GetMatrix()->Determinant()) > 0; // nor is it no number
}

std::vector<vtkVolume*> ShownVolumes(vtkRenderer* renderer)
{
  std::vector<vtkVolume*> shown;
  vtkCollectionSimpleIterator place;
  vtkVolumeCollection* volumes = renderer->GetVolumes();
  volumes->InitTraversal(place);
  while (vtkVolume* volume = volumes->GetNextVolume(place)) {
    const auto* drawn = vtkINRLODVolume::SafeDownCast(volume);
    if (drawn && !drawn->GetWithheld() && volume->GetVisibility() != 0 && HasSize(volume)) {
      shown.push_back(volume);
    }
  }
  return shown;
}

void DirectionInWorld(int axis, vtkImageData& image, vtkMatrix4x4& matrix, double way[4])
{
  for (int row = 0; row < 3; ++row) {
    way[row] = image.GetDirectionMatrix()->GetElement(row, axis);
  }
  way[3] = 0; // a direction, which is not moved
  matrix.MultiplyPoint(way, way);
}

bool IsTurned(vtkImageData* image, vtkMatrix4x4* matrix)
{
  constexpr double most = 1e-6; // of the volume's size, which no pixel shows
  for (int axis = 0; image && axis < 3; ++axis) {
    double way[4];
    DirectionInWorld(axis, *image, *matrix, way);
    const double longest = std::max({std::abs(way[0]), std::abs(way[1]), std::abs(way[2])});
    if (std::abs(way[0]) + std::abs(way[1]) + std::abs(way[2]) > (1 + most) * longest) {
      return true;
    }
  }
  return false;
}

bool MayOutshineWhite(vtkVolumeProperty* property, vtkRenderer* renderer)
{
  if (!property->GetShade()) {
    return false;
  }
  const double perLight = property->GetDiffuse() + property->GetSpecular();
  double sum = property->GetAmbient();
  vtkCollectionSimpleIterator place;
  vtkLightCollection* lights = renderer->GetLights();
  lights->InitTraversal(place);
  while (vtkLight* light = lights->GetNextLight(place)) {
    const double* color = light->GetDiffuseColor();
    const bool hasMost = !light->GetPositional() || light->GetAttenuationValues()[0] >= 1;
    const double most = hasMost ? std::max(light->GetIntensity(), 0.0) : HUGE_VAL;
    sum += light->GetSwitch() ? perLight * most * *std::max_element(color, color + 3) : 0.0;
  }
  return !(sum <= 1.0);
}

bool ComposesOnePicture(vtkRenderer* renderer)
{
  vtkIceTCompositePass* pass = CompositePassOf(renderer);
  return pass && IsOnePicture(pass);
}

bool AllHave(vtkMultiProcessController* processes, bool something)
{
  const int mine = something ? 1 : 0;
  int least = mine;
  if (AreSeveral(processes)) {
    processes->AllReduce(&mine, &least, 1, vtkCommunicator::MIN_OP);
  }
  return least > 0;
}

bool HaveSameModel(vtkMultiProcessController* processes, vtkDataSet* data, const char* name)
{
  if (!AreSeveral(processes)) {
    return true;
  }
  // Of who has no data, what changes neither.
  unsigned low = std::numeric_limits<unsigned>::max();
  unsigned high = 0;
  if (data && data->GetNumberOfPoints() > 0) {
    low = high = ChecksumOf(FindModelArray(data->GetPointData(), name));
  }
  unsigned least = low;
  unsigned largest = high;
  processes->AllReduce(&low, &least, 1, vtkCommunicator::MIN_OP);
  processes->AllReduce(&high, &largest, 1, vtkCommunicator::MAX_OP);
  return least >= largest;
}

} // namespace inr
