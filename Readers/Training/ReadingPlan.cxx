// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/ReadingPlan.h"

#include "Core/Error.h"
#include "Readers/Common/Extents.h"
#include "Readers/Training/UndividedSource.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>

namespace {

/// Times what a source tells of there may be: many tell of the active array alone.
constexpr double MostUntold = 4;

} // namespace

std::string FindFileProblem(vtkAlgorithm* consumer, vtkInformation* input, const StepsToRead& steps,
                            bool mayBeThere, const ControllerGroup& group)
{
  const bool isThere =
      mayBeThere && IsUpToDate(consumer) && IsPieceInMemory(input, WholeImage::Of(input), group);
  // None reads where others cannot.
  return group.firstOf(isThere ? "" : RawFiles(consumer, steps).problem());
}

ReadingPlan::ReadingPlan(vtkAlgorithm* consumer, vtkInformation* input, std::int64_t memoryLimit,
                         bool mayProbe, const ControllerGroup& group)
    : Consumer(consumer), MostBytes(static_cast<double>(group.memoryShare(memoryLimit)) / 2),
      Whole(WholeImage::Of(input)), Errors(std::make_unique<UpstreamErrors>(consumer))
{
  this->IsHeld = group.size() == 1
                     ? this->Whole.isInMemory
                     : IsPieceInMemory(input, this->Whole, group) || ComesFromApplication(consumer);
  this->Problem = FindFileProblem(consumer, input, {}, true, group);
  // All processes must decide alike, even where they see different files.
  const std::string wholeReader = group.firstOf(FindWholeFileReader(consumer));
  const bool isLarge = this->isTooLarge(this->Whole.bytes, group);
  this->InParts = wholeReader.empty();
  const std::string collective =
      group.size() > 1 ? group.firstOf(FindCollectiveFilter(consumer)) : std::string();
  const std::string whole =
      !this->InParts        ? wholeReader + ", the source, cannot give parts of its data"
      : !collective.empty() ? collective + " upstream gives all processes their parts at once"
                            : std::string();
  this->WhyWhole = isLarge ? whole : "";
  const bool mayBeLarge = this->InParts && this->isTooLarge(MostUntold * this->Whole.bytes, group);
  if (group.any(whole.empty() && isLarge)) {
    this->Asks = FirstAsked::VoxelOfTooMuch;
  } else if (mayProbe && group.size() == 1 && mayBeLarge) {
    this->Asks = FirstAsked::VoxelToLearn;
    this->Errors->hold(); // who cannot give a voxel may give all
  }
  if (this->Whole.dims.x * this->Whole.dims.y * this->Whole.dims.z == 0) {
    return;
  }
  if (this->Asks != FirstAsked::All || !this->Problem.empty()) {
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

/// The voxel that came, or all that there is where that is small enough or comes in one piece only.
vtkDataObject* ReadingPlan::afterProbe(vtkDataObject* data, bool failed,
                                       const ControllerGroup& group)
{
  auto* image = vtkImageData::SafeDownCast(data);
  const bool isUsable = !failed && image && image->GetPointData()->GetNumberOfArrays() > 0;
  const bool isKnown = !group.any(!isUsable);
  if (isKnown) {
    this->Whole.learnBytes(*image);
  }
  const int* const extent = this->Whole.extent;
  const bool isWhole = isKnown && std::equal(extent, extent + 6, image->GetExtent());
  const bool isLarge = isKnown ? group.any(this->isTooLarge(this->Whole.bytes, group))
                               : this->Asks == FirstAsked::VoxelOfTooMuch;
  const bool allWhole = !group.any(!isWhole);
  this->InPieces = isLarge && !allWhole;
  if (this->InPieces) {
    return data;
  }
  this->WhyWhole = isLarge ? "The source cannot give parts of its data" : "";
  // Also where all came: a filter may have made it of the one voxel that it asked for.
  const auto all = [&](vtkInformation* input) { this->ask(input, group); };
  const bool afresh = allWhole || group.size() > 1;
  const auto isThere = [&] { // of a group, FindPiece looks
    auto* const came = vtkImageData::SafeDownCast(data);
    return group.size() > 1 || !came || Contains(came->GetExtent(), extent);
  };
  group.together([&] {
    data = UpdateInput(*this->Consumer, all, afresh);
    if (!isThere()) {
      ForgetKept(*this->Consumer);
      data = UpdateInput(*this->Consumer, all, afresh);
    }
    if (!isThere()) {
      throw inr::Error(inr::ErrorCode::CannotRead, "the source did not give all of its voxels");
    }
  });
  return data;
}

ParallelInput ReadingPlan::find(vtkDataObject* data, std::unique_ptr<UpstreamErrors> errors,
                                const Finder& find, const ControllerGroup& group)
{
  const bool failed = group.any(errors && errors->any());
  if (this->Asks != FirstAsked::VoxelToLearn) {
    group.together([&] { errors ? errors->check() : void(); });
  }
  if (errors) {
    errors->endWatch(); // who reads on watches
  }
  vtkDataObject* found = data;
  try {
    found = this->Asks == FirstAsked::All ? data : this->afterProbe(data, failed, group);
  } catch (const inr::Error&) {
    if (errors) {
      errors->show(); // why no voxel came may be why no more do
    }
    throw;
  }
  if (group.size() > 1 && !this->InPieces) {
    return FindPiece(found, this->Whole, find, group);
  }
  ParallelInput input;
  group.together([&] { input.input = find(found); });
  RequireOneArray(input.input.info.arrayName, group);
  return input;
}
