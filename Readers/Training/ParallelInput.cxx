// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/ParallelInput.h"

#include "Core/Error.h"
#include "Readers/Common/Extents.h"

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
std::array<int, 6> PieceOfGroup(const int* whole, const ControllerGroup& group)
{
  return PieceExtent(whole, group.rank(), group.size(), 0);
}

/// The first of the processes that say so; that with rank 0 where none does.
std::size_t FirstOf(bool said, const ControllerGroup& group)
{
  const std::vector<bool> all = group.valuesOfAll(said);
  const auto first = std::find(all.begin(), all.end(), true);
  return first == all.end() ? 0 : static_cast<std::size_t>(first - all.begin());
}

/// Of the whole image, also where this process' source tells of none.
std::array<int, 6> ExtentOfWhole(const WholeImage& whole, const ControllerGroup& group)
{
  std::array<int, 6> own{};
  std::copy_n(whole.extent, 6, own.data());
  const std::size_t first = FirstOf(!IsEmpty(whole.extent), group);
  return group.valuesOfAll(own)[first];
}

/// Whether all processes of the group have what VTK would cut for them, or more. Those of a
/// simulation have cut the image in their own way.
bool IsCutByVTK(vtkImageData* image, const int* wanted, const ControllerGroup& group)
{
  const bool here = IsEmpty(wanted) || (image && Contains(image->GetExtent(), wanted));
  return group.all(here);
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

/// What the process with rank `knowing` knows of the whole, the others learn.
void ShareInfo(inr::VolumeInfo& info, std::size_t knowing, const ControllerGroup& group)
{
  info.type = group.valuesOfAll(info.type)[knowing];
  info.dims = group.valuesOfAll(info.dims)[knowing];
  info.origin = group.valuesOfAll(info.origin)[knowing];
  info.spacing = group.valuesOfAll(info.spacing)[knowing];
  info.direction = group.valuesOfAll(info.direction)[knowing];
  info.arrayName = group.gather(info.arrayName)[knowing];
  const double time = group.valuesOfAll(info.time.value_or(0.0))[knowing];
  info.time = group.valuesOfAll(info.time.has_value())[knowing] ? std::optional<double>(time)
                                                                : std::nullopt;
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
  const std::array<int, 6> piece = PieceOfGroup(whole.extent, group);
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
  const std::array<int, 6> all = ExtentOfWhole(whole, group);
  const std::array<int, 6> wanted = PieceOfGroup(all.data(), group);
  const bool cut = IsCutByVTK(image, wanted.data(), group);
  vtkSmartPointer<vtkImageData> piece;
  group.together([&] { piece = image ? PieceOf(image, wanted.data(), cut) : nullptr; });
  const std::size_t first = FirstOf(piece != nullptr, group);
  group.together([&] {
    if (!piece) {
      if (!image || static_cast<std::size_t>(group.rank()) == first) {
        find(data); // says what is wrong with it
      }
      return; // more processes than the image can be cut for, or one that has no part of it
    }
    found.input = find(piece);
    const int* const extent = piece->GetExtent();
    for (int axis = 0; axis < 3; ++axis) {
      found.first[axis] = std::int64_t{extent[2 * axis]} - all[2 * axis];
    }
    info.dims = whole.dims;
    piece->TransformIndexToPhysicalPoint(all[0], all[2], all[4], &info.origin.x);
  });
  const std::string name = group.gather(info.arrayName)[first];
  RequireOneArray(found.input.values ? info.arrayName : name, group);
  ShareInfo(info, first, group);
  group.together([&] {
    if (found.input.values && found.input.data.type != info.type) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "array '" + info.arrayName + "' holds " +
                           inr::ScalarName(found.input.data.type) + " here and " +
                           inr::ScalarName(info.type) + " in process " + std::to_string(first));
    }
  });
  return found;
}
