// SPDX-License-Identifier: BSD-3-Clause
#include "ReadingPlan.h"

#include "RawFiles.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>

#include <algorithm>

namespace {

/// Times what a source tells of there may be: many tell of the active array alone.
constexpr double MostUntold = 16;

} // namespace

std::string FindFileProblem(vtkAlgorithm* consumer, vtkInformation* input, bool allSteps,
                            const ControllerGroup& group)
{
  // Who has the data does not need the file; but none reads where others cannot.
  const bool isThere = IsUpToDate(consumer) && IsPieceInMemory(input, WholeImage::Of(input), group);
  return group.firstOf(isThere ? "" : RawFiles(consumer, allSteps).problem());
}

ReadingPlan::ReadingPlan(vtkAlgorithm* consumer, vtkInformation* input, std::int64_t memoryLimit,
                         const ControllerGroup& group)
    : Consumer(consumer), MostBytes(static_cast<double>(group.memoryShare(memoryLimit)) / 2),
      Whole(WholeImage::Of(input)), Errors(std::make_unique<UpstreamErrors>(consumer))
{
  const bool hasPiece = IsPieceInMemory(input, this->Whole, group);
  this->IsHeld =
      group.size() == 1 ? this->Whole.isInMemory : hasPiece || ComesFromApplication(consumer);
  this->Problem = FindFileProblem(consumer, input, false, group);
  const std::string wholeReader = FindWholeFileReader(consumer);
  this->InParts = wholeReader.empty();
  if (!this->InParts && this->isTooLarge(this->Whole.bytes, group)) {
    this->WholeReader = wholeReader + ", the source";
  }
  const bool mayBeTooLarge = this->isTooLarge(MostUntold * this->Whole.bytes, group);
  this->InPieces = group.any(this->InParts && mayBeTooLarge);
  if (this->Whole.dims.x * this->Whole.dims.y * this->Whole.dims.z == 0) {
    return;
  }
  if (this->InPieces || !this->Problem.empty()) {
    this->Whole.ask(input, true);
  } else {
    this->ask(input, group);
  }
}

/// For the whole, or for a piece of it.
void ReadingPlan::ask(vtkInformation* input, const ControllerGroup& group) const
{
  if (group.size() > 1) {
    RequestPiece(input, this->Whole, this->InParts, group);
  } else {
    this->Whole.ask(input, false);
  }
}

/// Whether to hold what this process would train on is too much for its share of the memory limit;
/// what it holds already, it keeps.
bool ReadingPlan::isTooLarge(double bytes, const ControllerGroup& group) const
{
  return !this->IsHeld && bytes / group.size() > this->MostBytes;
}

/// What came, or all of it where a voxel came which shows that it is small enough.
vtkDataObject* ReadingPlan::completed(vtkDataObject* data, const ControllerGroup& group)
{
  auto* image = vtkImageData::SafeDownCast(data);
  const int* const extent = this->Whole.extent;
  const bool isWhole = image && std::equal(extent, extent + 6, image->GetExtent());
  if (image) {
    this->Whole.learnBytes(*image);
  }
  const bool tooLarge = group.any(this->isTooLarge(this->Whole.bytes, group));
  if (!group.any(!isWhole)) { // although a voxel was asked for
    this->InPieces = false;
    this->WholeReader = tooLarge ? "The source" : "";
  } else if (!tooLarge) {
    this->InPieces = false;
    const auto all = [&](vtkInformation* input) { this->ask(input, group); };
    group.together([&] { data = UpdateInput(*this->Consumer, all, group.size() > 1); });
  }
  return data;
}

ParallelInput ReadingPlan::find(vtkDataObject* data, const Finder& find,
                                const ControllerGroup& group)
{
  vtkDataObject* const found = this->InPieces ? this->completed(data, group) : data;
  if (group.size() > 1 && !this->InPieces) {
    return FindPiece(found, this->Whole, find, group);
  }
  ParallelInput input;
  group.together([&] { input.input = find(found); });
  return input;
}
