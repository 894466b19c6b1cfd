// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Streaming/StreamedVolume.h"

#include "Core/Error.h"
#include "Core/GridBox.h"
#include "Core/NumberText.h"
#include "Core/Training/Samples/RandomStream.h"
#include "Core/Training/TrainingRun.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace inr {

namespace {

constexpr std::int64_t VoxelsOfBar = std::int64_t{1} << 17;
/// Small enough for all processes of a group to get as many.
constexpr std::int64_t VoxelsOfMeasuredBlock = std::int64_t{1} << 20;

constexpr double MostReadings = 3.0;

/// Share of the range by which a value may differ when it is computed again.
constexpr double SameValue = 1e-6;

/// Blocks of at most so many voxels, and enough of them for each process to have about as many.
BlockGrid BlocksFor(const VolumeReader& reader, std::int64_t mostVoxels, int processes)
{
  constexpr std::int64_t enough = 8;
  BlockGrid blocks(reader.dims(), mostVoxels, reader.margin());
  while (processes > 1 && blocks.count() < enough * processes && mostVoxels > 1) {
    mostVoxels /= 2;
    blocks = BlockGrid(reader.dims(), mostVoxels, reader.margin());
  }
  return blocks;
}

/// One bar in each of `count` parts of them all, which are as equal as can be: no bar twice.
std::vector<std::int64_t> ChooseBars(std::int64_t bars, std::int64_t count, std::uint64_t seed)
{
  const std::uint64_t stream = StreamSeed(seed, RandomStream::Bars);
  std::vector<std::int64_t> chosen;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t first = k * bars / count;
    const std::int64_t size = (k + 1) * bars / count - first;
    const double within = RandomUnit(stream, static_cast<std::uint64_t>(k));
    chosen.push_back(first + static_cast<std::int64_t>(within * static_cast<double>(size)));
  }
  return chosen;
}

std::string ToText(const GridBox& box)
{
  const auto axis = [&](int a) {
    return std::to_string(box.first[a]) + " to " + std::to_string(box.end()[a] - 1);
  };
  return "(" + axis(0) + ", " + axis(1) + ", " + axis(2) + ")";
}

} // namespace

StreamedVolume::StreamedVolume(VolumeReader& reader, const StreamBudget& budget, int macroCellSize,
                               const TrainingOptions& options, const TrainingGroup& group,
                               const Arena& arena)
    : Reader(reader), Group(group), Threads(arena), MacroCellSize(macroCellSize),
      Seed(options.seed), MeasuredVoxels(options.measuredVoxels), BlockVoxels(budget.blockVoxels),
      Blocks(BlocksFor(reader, budget.blockVoxels, group.size())),
      Share(this->Blocks.count(), group.rank(), group.size()),
      Pool(this->Blocks,
           std::min(budget.poolSamples * this->Blocks.count() / this->Share.mostBlocks,
                    2 * GridCount(reader.dims())),
           options.seed, this->Share),
      Ranges(reader.dims(), macroCellSize),
      EstimatePositions(
          PsnrEstimate::positions(reader.dims(), options.seed, PsnrEstimate::StoringVoxels)),
      EstimateValues(this->EstimatePositions.size()),
      EstimatesOfBlocks(static_cast<std::size_t>(this->Blocks.count()))
{
  for (std::size_t k = 0; k < this->EstimatePositions.size(); ++k) {
    const std::int64_t block = this->Blocks.blockAt(this->EstimatePositions[k]);
    this->EstimatesOfBlocks[static_cast<std::size_t>(block)].push_back(k);
  }
}

bool StreamedVolume::measuresAll() const
{
  return GridCount(this->Reader.dims()) <= 4 * this->MeasuredVoxels;
}

/// Whatever a reader does, what it gives has to be the box.
VolumePiece StreamedVolume::read(const GridBox& box)
{
  const VolumePiece piece = this->Reader.read(box);
  if (piece.data.values == nullptr || piece.data.dims != box.size || piece.first != box.first ||
      piece.data.type != this->Reader.type()) {
    throw Error(ErrorCode::InvalidArgument,
                "the source gave something else than the voxels " + ToText(box));
  }
  return piece;
}

/// Takes part in what others read.
void StreamedVolume::readNothing() { this->read({glm::i64vec3(0), glm::i64vec3(1)}); }

PsnrEstimate StreamedVolume::estimate(std::int64_t voxels) const
{
  std::vector<float> targets;
  const double low = this->Statistics.low - this->Pool.origin();
  const double high = this->Statistics.high - this->Pool.origin();
  for (std::int64_t k = 0; k < voxels; ++k) {
    targets.push_back(
        NormalisedTarget(this->EstimateValues[static_cast<std::size_t>(k)], low, high));
  }
  return {{this->EstimatePositions.begin(), this->EstimatePositions.begin() + voxels},
          std::move(targets),
          this->Threads};
}

SamplePool& StreamedVolume::begin(double rereads)
{
  this->Pool.begin(this->Statistics.low, this->Statistics.high, rereads);
  return this->Pool;
}

double StreamedVolume::mostRereads() const
{
  const double once = this->Blocks.readShare();
  const double all = this->Reader.margin() > 0 ? this->measuredBoxes().readShare() : 1.0;
  const double measured = this->measuresAll()
                              ? all
                              : static_cast<double>(this->MeasuredVoxels + VoxelsOfBar) /
                                    static_cast<double>(GridCount(this->Reader.dims()));
  return std::clamp((MostReadings - measured - once) / once, 0.0, 1.0);
}

void StreamedVolume::requireKnownRange(const VolumePiece& piece, const GridBox& box) const
{
  const VolumeStatistics now = MeasureBox(piece, box, this->Threads);
  const double low = this->Statistics.low - this->tolerance();
  const double high = this->Statistics.high + this->tolerance();
  if (now.low < low || now.high > high) {
    throw Error(ErrorCode::InvalidArgument,
                "the data changed while they were read: voxels " + ToText(box) + " now are " +
                    NumberText(now.low, 10) + " to " + NumberText(now.high, 10) + ", outside " +
                    NumberText(this->Statistics.low, 10) + " to " +
                    NumberText(this->Statistics.high, 10) +
                    ", the range of all data when they were read for the first time");
  }
  if (now.nonFinite > this->Statistics.nonFinite) {
    throw Error(ErrorCode::InvalidArgument,
                "the data changed while they were read: of the voxels " + ToText(box) + " now " +
                    std::to_string(now.nonFinite) + " are not finite, and of all voxels " +
                    std::to_string(this->Statistics.nonFinite) +
                    " were not when they were read for the first time");
  }
}

/// Of a volume all of whose voxels were measured.
void StreamedVolume::requireKnownFinite(std::int64_t finite) const
{
  const std::int64_t before = GridCount(this->Reader.dims()) - this->Statistics.nonFinite;
  if (finite != before) {
    throw Error(ErrorCode::InvalidArgument,
                "the data changed while they were read: " + std::to_string(finite) +
                    " voxels are finite now, and " + std::to_string(before) +
                    " were when they were read for the first time");
  }
}

/// Those of the estimate's voxels that a piece of just this box tells as one does that holds more:
/// not at its faces, where rounding may put a voxel's centre towards the voxel beyond.
std::vector<std::size_t> StreamedVolume::estimatesWithin(const GridBox& box) const
{
  const glm::i64vec3 dims = this->Reader.dims();
  const auto isWithin = [&](const glm::vec3& position) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto voxel = static_cast<std::int64_t>(static_cast<double>(position[axis]) *
                                                   static_cast<double>(dims[axis]));
      const std::int64_t first = box.first[axis];
      const std::int64_t end = box.end()[axis];
      if (voxel < first + (first > 0 ? 1 : 0) || voxel >= end - (end < dims[axis] ? 1 : 0)) {
        return false;
      }
    }
    return true;
  };
  std::vector<std::size_t> within;
  for (std::size_t k = 0; k < this->EstimatePositions.size(); ++k) {
    if (isWithin(this->EstimatePositions[k])) {
      within.push_back(k);
    }
  }
  return within;
}

/// Looks at those of PsnrEstimate: within the range they may have changed, too, the more easily
/// since the first reading was in another process.
void StreamedVolume::requireKnownValues(const VolumePiece& piece, const GridBox& box,
                                        const std::vector<std::size_t>& estimates) const
{
  std::int64_t differing = 0;
  for (const std::size_t k : estimates) {
    double now = 0;
    SamplePiece(piece, this->Reader.dims(), &this->EstimatePositions[k], 1, this->Pool.origin(),
                &now);
    differing += CountDifferences(&now, &this->EstimateValues[k], 1, this->tolerance());
  }
  if (differing > 0) {
    throw Error(ErrorCode::InvalidArgument,
                "the data changed after they were first read: of the voxels " + ToText(box) +
                    " at least " + std::to_string(differing) +
                    " have other values; if these are right, begin the training anew");
  }
}

double StreamedVolume::tolerance() const
{
  return SameValue * (this->Statistics.high - this->Statistics.low);
}

void StreamedVolume::readAgain()
{
  const std::optional<std::int64_t> block = this->Pool.wanted();
  if (block) {
    this->readAgain(*block);
  }
}

void StreamedVolume::readAgain(std::int64_t block)
{
  const VolumePiece piece = this->read(this->Blocks.voxels(block));
  const GridBox own = this->Blocks.ownVoxels(block);
  this->requireKnownRange(piece, own);
  this->requireKnownValues(piece, own, this->EstimatesOfBlocks[static_cast<std::size_t>(block)]);
  this->Pool.offer(block, this->Pool.sample(block, 1, piece, this->Threads));
}

/// Before what all do: none begins to read where another stops.
bool StreamedVolume::allGoOn(const StopCheck& check) const
{
  bool goesOn = true;
  this->Group.together([&] { goesOn = check.goesOn(); });
  return this->Group.all(goesOn);
}

/// A training that was resumed may owe most of the volume.
bool StreamedVolume::readBefore(const TrainingStep& step, const StopCheck& check)
{
  while (const std::optional<std::int64_t> block = this->Pool.owed(step)) {
    if (!this->allGoOn(check)) {
      return false;
    }
    this->Group.together([&] {
      if (*block != SamplePool::NoBlock) {
        this->readAgain(*block);
      } else {
        this->readNothing();
        this->Pool.offer(*block, {});
      }
    });
  }
  return true;
}

/// Every n-th of the chosen boxes is of this process.
void StreamedVolume::measureShare(const BlockGrid& boxes, const std::vector<std::int64_t>& chosen,
                                  QualityMeter& meter, CellRanges* decoded,
                                  const Progress& progress)
{
  const auto size = static_cast<std::size_t>(this->Group.size());
  for (std::size_t first = 0; first < chosen.size(); first += size) {
    const std::size_t k = first + static_cast<std::size_t>(this->Group.rank());
    const GridBox own = k < chosen.size() ? boxes.ownVoxels(chosen[k]) : GridBox();
    const auto done = [&](double part) {
      progress((static_cast<double>(first) + part * static_cast<double>(size)) /
               static_cast<double>(chosen.size()));
    };
    this->Group.together([&] {
      if (own.count() == 0) {
        size > 1 ? this->readNothing() : void();
        done(0); // who has nothing to do may stop the others, too
        return;
      }
      const VolumePiece piece = this->read(own);
      this->requireKnownRange(piece, own);
      this->requireKnownValues(piece, own, this->estimatesWithin(own));
      meter.add(piece, decoded, done);
    });
  }
}

BlockGrid StreamedVolume::measuredBoxes() const
{
  const std::int64_t most = this->measuresAll() ? VoxelsOfMeasuredBlock : VoxelsOfBar;
  return {this->Reader.dims(), std::min(this->BlockVoxels, most), this->Reader.margin()};
}

DecodedReport StreamedVolume::measure(const Evaluator& evaluator, const Model& model,
                                      const Progress& progress)
{
  const bool all = this->measuresAll();
  const BlockGrid boxes = this->measuredBoxes();
  const double share = static_cast<double>(this->MeasuredVoxels) /
                       static_cast<double>(GridCount(this->Reader.dims()));
  const std::int64_t count =
      all ? boxes.count() : std::llround(std::ceil(share * static_cast<double>(boxes.count())));
  QualityMeter meter(evaluator, model.volume, this->Threads, BandSize(model.description));
  std::optional<CellRanges> decoded;
  if (all) {
    decoded.emplace(this->Reader.dims(), this->MacroCellSize);
  }
  this->measureShare(boxes, ChooseBars(boxes.count(), count, this->Seed), meter,
                     all ? &*decoded : nullptr, progress);
  meter.gather(this->Group);
  Quality quality = meter.quality();
  if (all) {
    this->requireKnownFinite(meter.errors().voxels);
    decoded->gather(this->Group);
    return {quality, decoded->cells(0.0, 1.0, 0.0, MacroCellProvenance::Decoded)};
  }
  quality.sampledVoxels = static_cast<std::uint64_t>(meter.errors().voxels);
  return {quality, this->Ranges.cells(model.volume.low, model.volume.high, meter.errors().largest,
                                      MacroCellProvenance::Training)};
}

} // namespace inr
