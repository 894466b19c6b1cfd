// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Streaming/StreamBudget.h"

#include "Core/Error.h"
#include "Core/Mebibytes.h"
#include "Core/Training/Descent/GradientExchange.h"
#include "Core/Training/Samples/BatchSource.h"
#include "Core/Training/Samples/BlockGrid.h"
#include "Core/Training/TrainingRun.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace inr {

namespace {

constexpr std::int64_t MiB = std::int64_t{1} << 20;

/// Threads, code, and the slices that quality is measured on.
constexpr std::int64_t Overhead = 96 * MiB;

/// Ranges of macro-cells that processes tell each other at a time.
constexpr std::int64_t GatheredRanges = MiB;

/// Pieces smaller than this are slow to read, and a small pool repeats itself.
constexpr std::int64_t SmallestShare = 4 * MiB;
constexpr std::int64_t LargestBlock = 64 * MiB;
constexpr std::int64_t LargestPool = 512 * MiB;

/// A source may hold a piece twice: as it came from the disk, and as it is handed on.
constexpr std::int64_t CopiesOfBlock = 3;

std::int64_t CellBytes(const VolumeInfo& info, const TrainingOptions& options)
{
  // Of data and decoded ones as doubles, twice as floats.
  return 48 * CountMacroCells(info.dims, MacroCellSizeOf(info, options));
}

bool IsAccelerated(const TrainingOptions& options, int processes)
{
  return processes == 1 && options.acceleration.accelerator;
}

/// What is left for pieces and samples.
std::int64_t FreeBytes(const VolumeInfo& info, const TrainingOptions& options,
                       const Description& description, int processes)
{
  const std::int64_t exchanged =
      processes > 1 ? std::max(ExchangeBytes(Layout(description), processes),
                               (2 * processes + 1) * GatheredRanges) // not at the same time
                    : 0;
  return options.memoryLimit - Overhead - exchanged - CellBytes(info, options) -
         TrainingBytes(description, IsAccelerated(options, processes));
}

std::int64_t LeastFreeBytes() { return (CopiesOfBlock + 1) * SmallestShare; }

const char* LimitText(int processes)
{
  return processes > 1 ? " in each process and its share of the MemoryLimit is "
                       : " and the MemoryLimit is ";
}

/// Whatever the model.
void RequireRoomForCells(const VolumeInfo& info, const TrainingOptions& options, int processes)
{
  const std::int64_t cells = CellBytes(info, options);
  const std::int64_t others = Overhead + LeastFreeBytes();
  if (cells + others > options.memoryLimit && cells > others) {
    throw Error(ErrorCode::InvalidArgument,
                "the ranges of macro-cells of " + std::to_string(MacroCellSizeOf(info, options)) +
                    " voxels, of a volume read in pieces, take " + InMebibytes(cells + others) +
                    " with what they are measured in" + LimitText(processes) +
                    InMebibytes(options.memoryLimit) +
                    "; raise it or choose a larger MacroCellSize");
  }
}

constexpr int MostHalvings = 40; // of the default model: by then it is the smallest

Description DescriptionAt(double ratio, const VolumeInfo& info, const TrainingOptions& options)
{
  return ChooseDescription(info.dims, info.type, ratio, options.storedAs, options.macroCellSize);
}

Description FittingDescription(const VolumeInfo& info, const TrainingOptions& options,
                               int processes)
{
  const auto choose = [&](double ratio) { return DescriptionAt(ratio, info, options); };
  if (options.description || options.targetRatio > 0) {
    return options.description.value_or(choose(options.targetRatio));
  }
  constexpr int fewestHalvings = 4;
  Description description = choose(0);
  for (int halvings = fewestHalvings; halvings < MostHalvings; ++halvings) {
    if (TrainingBytes(description, IsAccelerated(options, processes)) <=
            options.memoryLimit / 2 && // the rest is left to the data
        FreeBytes(info, options, description, processes) >= LeastFreeBytes()) {
      break;
    }
    description = choose(std::ldexp(1.0, halvings));
  }
  return description;
}

} // namespace

std::int64_t TrainingBytes(const Description& description, bool accelerated)
{
  // Four floats, a count of updates, marks; three floats and a count.
  const std::int64_t bytesPerParameter = accelerated ? 19 + 14 : 19;
  constexpr std::int64_t shards = 16; // gradients of the network that are then summed
  const Layout layout(description);
  return bytesPerParameter * static_cast<std::int64_t>(layout.parameterCount) +
         shards * 4 * static_cast<std::int64_t>(layout.gridOffset) +
         BatchSize * std::int64_t{4 * layout.encodedWidth + 16};
}

StreamBudget PlanStream(const VolumeInfo& info, const TrainingOptions& options,
                        std::int64_t bytesPerVoxel, int processes)
{
  RequireRoomForCells(info, options, processes);
  StreamBudget budget{FittingDescription(info, options, processes), 0, 0};
  const std::int64_t left = FreeBytes(info, options, budget.description, processes);
  if (left < LeastFreeBytes()) {
    const bool accelerated = IsAccelerated(options, processes);
    const Description smallest = DescriptionAt(std::ldexp(1.0, MostHalvings), info, options);
    const std::int64_t leftBySmallest = left + TrainingBytes(budget.description, accelerated) -
                                        TrainingBytes(smallest, accelerated);
    throw Error(ErrorCode::InvalidArgument,
                "training a model of " + std::to_string(Layout(budget.description).parameterCount) +
                    " parameters from a volume read in pieces takes " +
                    InMebibytes(options.memoryLimit - left + LeastFreeBytes()) +
                    LimitText(processes) + InMebibytes(options.memoryLimit) + "; raise it" +
                    (leftBySmallest < LeastFreeBytes()
                         ? ", as the smallest model takes too much, too"
                         : " or ask for a smaller model (TargetRatio, or ModelConfig)"));
  }
  const std::int64_t block = std::clamp(left / (2 * CopiesOfBlock), SmallestShare, LargestBlock);
  const std::int64_t pool = std::min(left - CopiesOfBlock * block, LargestPool);
  budget.blockVoxels = block / bytesPerVoxel;
  budget.poolSamples = pool / static_cast<std::int64_t>(sizeof(double));
  return budget;
}

} // namespace inr
