// SPDX-License-Identifier: BSD-3-Clause
#include "ReadingPlan.h"

#include "RawFiles.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>

#include <algorithm>

ReadingPlan::ReadingPlan(vtkAlgorithm* consumer, vtkInformation* input, std::int64_t memoryLimit,
                         const ControllerGroup& group)
    : Whole(WholeImage::Of(input)), Errors(std::make_unique<UpstreamErrors>(consumer))
{
  // Who has the data does not need the file; but none reads where others cannot.
  const bool isThere = IsUpToDate(consumer) && IsPieceInMemory(input, this->Whole, group);
  this->Problem = group.firstOf(isThere ? "" : RawFiles(consumer).problem());
  const bool isLarge = this->isTooLarge(consumer, input, memoryLimit, group);
  const std::string wholeReader = FindWholeFileReader(consumer);
  this->WholeReader = isLarge && !wholeReader.empty() ? wholeReader + ", the source" : "";
  this->InPieces = group.any(isLarge && this->WholeReader.empty());
  if (this->Whole.dims.x * this->Whole.dims.y * this->Whole.dims.z == 0) {
    return;
  }
  if (group.size() > 1 && this->Problem.empty() && !this->InPieces) {
    RequestPiece(input, this->Whole, wholeReader.empty(), group);
  } else {
    this->Whole.ask(input, this->InPieces || !this->Problem.empty());
  }
}

/// Whether to hold what this process would train on is too much for its share of the memory limit;
/// what it holds already, it keeps.
bool ReadingPlan::isTooLarge(vtkAlgorithm* consumer, vtkInformation* input,
                             std::int64_t memoryLimit, const ControllerGroup& group) const
{
  const auto limit = static_cast<double>(group.memoryShare(memoryLimit));
  if (this->Whole.bytes / group.size() <= limit / 2) {
    return false;
  }
  return group.size() == 1
             ? !this->Whole.isInMemory
             : !IsPieceInMemory(input, this->Whole, group) && !ComesFromApplication(consumer);
}

ParallelInput ReadingPlan::find(vtkDataObject* data, const Finder& find,
                                const ControllerGroup& group)
{
  auto* image = vtkImageData::SafeDownCast(data);
  const int* const extent = this->Whole.extent;
  const bool isWhole = image && std::equal(extent, extent + 6, image->GetExtent());
  if (this->InPieces && !group.any(!isWhole)) { // although a voxel was asked for
    this->InPieces = false;
    this->WholeReader = "The source";
  }
  if (group.size() > 1 && !this->InPieces) {
    return FindPiece(data, this->Whole, find, group);
  }
  ParallelInput found;
  group.together([&] { found.input = find(data); });
  return found;
}
