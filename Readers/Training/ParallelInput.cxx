// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/ParallelInput.h"

#include "Core/Error.h"
#include "Readers/Extents.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <vector>

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// As VTK cuts an image for the processes of the group; empty for those that are too many.
std::array<int, 6> PieceOfGroup(const WholeImage& whole, const ControllerGroup& group)
{
  return PieceExtent(whole.extent, group.rank(), group.size(), 0);
}

/// Whether all processes of the group have what VTK would cut for them, or more. Those of a
/// simulation have cut the image in their own way.
bool IsCutByVTK(vtkImageData* image, const int* wanted, const ControllerGroup& group)
{
  const bool here = IsEmpty(wanted) || (image && Contains(image->GetExtent(), wanted));
  const std::vector<int> all = group.valuesOfAll(static_cast<int>(here));
  return std::count(all.begin(), all.end(), 0) == 0;
}

/// The process' piece of what it has got, which may be all that there is; null where it has none.
vtkSmartPointer<vtkImageData> PieceOf(vtkImageData* image, const int* wanted, bool cut)
{
  if (image->GetNumberOfPoints() == 0 || (cut && IsEmpty(wanted))) {
    return nullptr;
  }
  auto piece = vtkSmartPointer<vtkImageData>::New();
  piece->ShallowCopy(image);
  if (cut) {
    int extent[6];
    std::copy_n(wanted, 6, extent);
    piece->Crop(extent); // nothing is copied where the extents are the same
  }
  return piece;
}

/// What the first process knows of the whole, the others learn.
void ShareInfo(inr::VolumeInfo& info, const ControllerGroup& group)
{
  info.type = group.valueOfFirst(info.type);
  info.dims = group.valueOfFirst(info.dims);
  info.arrayName = group.fromFirst(info.arrayName);
  const double time = group.valueOfFirst(info.time.value_or(0.0));
  info.time =
      group.valueOfFirst(info.time.has_value()) ? std::optional<double>(time) : std::nullopt;
}

} // namespace

void RequireOneArray(const std::string& name, const ControllerGroup& group)
{
  const std::string first = group.fromFirst(name);
  group.together([&] {
    if (name != first) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "the array to be saved is '" + name + "' here and '" + first +
                           "' in the first process; choose one that all processes have");
    }
  });
}

bool IsPieceInMemory(vtkInformation* input, const WholeImage& whole, const ControllerGroup& group)
{
  auto* image = vtkImageData::SafeDownCast(input->Get(vtkDataObject::DATA_OBJECT()));
  const std::array<int, 6> piece = PieceOfGroup(whole, group);
  return image && image->GetPointData()->GetNumberOfArrays() > 0 &&
         (IsEmpty(piece.data()) || Contains(image->GetExtent(), piece.data()));
}

void RequestPiece(vtkInformation* input, const WholeImage& whole, bool inParts,
                  const ControllerGroup& group)
{
  int extent[6];
  std::copy_n(whole.extent, 6, extent); // of which the source's executive cuts the piece
  input->Set(Pipeline::UPDATE_PIECE_NUMBER(), inParts ? group.rank() : 0);
  input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), inParts ? group.size() : 1);
  input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  input->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
}

ParallelInput FindPiece(vtkDataObject* data, const WholeImage& whole,
                        const std::function<TrainingInput(vtkDataObject*)>& find,
                        const ControllerGroup& group)
{
  ParallelInput found;
  inr::VolumeInfo& info = found.input.info;
  auto* const image = vtkImageData::SafeDownCast(data);
  const std::array<int, 6> wanted = PieceOfGroup(whole, group);
  const bool cut = IsCutByVTK(image, wanted.data(), group);
  group.together([&] {
    const vtkSmartPointer<vtkImageData> piece =
        image ? PieceOf(image, wanted.data(), cut) : nullptr;
    if (!piece) {
      if (!image || group.rank() == 0) {
        find(data); // says what is wrong with it
      }
      return; // more processes than the image can be cut for
    }
    found.input = find(piece);
    const int* const extent = piece->GetExtent();
    for (int axis = 0; axis < 3; ++axis) {
      found.first[axis] = std::int64_t{extent[2 * axis]} - whole.extent[2 * axis];
    }
    info.dims = whole.dims;
    piece->TransformIndexToPhysicalPoint(whole.extent[0], whole.extent[2], whole.extent[4],
                                         &info.origin.x);
  });
  const std::string first = group.fromFirst(info.arrayName);
  RequireOneArray(found.input.values ? info.arrayName : first, group);
  ShareInfo(info, group);
  group.together([&] {
    if (found.input.values && found.input.data.type != info.type) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "array '" + info.arrayName + "' holds " +
                           inr::ScalarName(found.input.data.type) + " here and " +
                           inr::ScalarName(info.type) + " in the first process");
    }
  });
  return found;
}
