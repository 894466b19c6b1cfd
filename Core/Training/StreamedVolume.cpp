// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/StreamedVolume.h"

#include "Core/Error.h"
#include "Core/Random.h"
#include "Core/Training/TrainingClock.h"
#include "Core/Training/TrainingRun.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

namespace inr {

namespace {

constexpr std::int64_t VoxelsOfBar = std::int64_t{1} << 17;
/// What SSIM keeps of a slice is large.
constexpr std::int64_t VoxelsOfMeasuredBlock = std::int64_t{1} << 20;

constexpr double MostReadings = 3.0;
constexpr std::uint64_t BarStream = 6; // apart from those of SamplePool

std::int64_t Voxels(const glm::i64vec3& dims) { return dims.x * dims.y * dims.z; }

/// One bar in each of `count` equal parts of them all.
std::vector<std::int64_t> ChooseBars(std::int64_t bars, std::int64_t count, std::uint64_t seed)
{
  const std::uint64_t stream = RandomBits(seed, BarStream);
  std::vector<std::int64_t> chosen;
  for (std::int64_t k = 0; k < count; ++k) {
    const double within = RandomUnit(stream, static_cast<std::uint64_t>(k));
    const double share = (static_cast<double>(k) + within) / static_cast<double>(count);
    chosen.push_back(static_cast<std::int64_t>(share * static_cast<double>(bars)));
  }
  return chosen;
}

std::string ToText(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string ToText(const VoxelBox& box)
{
  const auto axis = [&](int a) {
    return std::to_string(box.first[a]) + " to " + std::to_string(box.end()[a] - 1);
  };
  return "(" + axis(0) + ", " + axis(1) + ", " + axis(2) + ")";
}

} // namespace

StreamedVolume::StreamedVolume(VolumeReader& reader, const StreamBudget& budget, int macroCellSize,
                               const TrainingOptions& options, const Arena& arena)
    : Reader(reader), Threads(arena), MacroCellSize(macroCellSize), Seed(options.seed),
      MeasuredVoxels(options.measuredVoxels), BlockVoxels(budget.blockVoxels),
      Blocks(reader.dims(), budget.blockVoxels),
      Pool(this->Blocks, std::min(budget.poolSamples, 2 * Voxels(reader.dims())), options.seed),
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
  return Voxels(this->Reader.dims()) <= 4 * this->MeasuredVoxels;
}

/// Whatever a reader does, what it gives has to be the box.
VolumePiece StreamedVolume::read(const VoxelBox& box)
{
  const VolumePiece piece = this->Reader.read(box);
  if (piece.data.values == nullptr || piece.data.dims != box.size || piece.first != box.first ||
      piece.data.type != this->Reader.type()) {
    throw Error(ErrorCode::InvalidArgument,
                "the source gave something else than the voxels " + ToText(box));
  }
  return piece;
}

void StreamedVolume::survey(const Progress& progress)
{
  const TrainingClock clock;
  for (std::int64_t block = 0; block < this->Blocks.count(); ++block) {
    progress(static_cast<double>(block) / static_cast<double>(this->Blocks.count()));
    const VolumePiece piece = this->read(this->Blocks.voxels(block));
    const VoxelBox own = this->Blocks.ownVoxels(block);
    this->Statistics.add(MeasureBox(piece, own, this->Threads));
    if (!this->measuresAll()) {
      this->Ranges.add(piece, own, this->Threads);
    }
    this->Pool.put(block, this->Pool.sample(block, 0, piece, this->Threads));
    this->sampleEstimate(block, piece);
  }
  this->SurveySeconds = clock.seconds();
}

void StreamedVolume::sampleEstimate(std::int64_t block, const VolumePiece& piece)
{
  for (const std::size_t k : this->EstimatesOfBlocks[static_cast<std::size_t>(block)]) {
    SamplePiece(piece, this->Reader.dims(), &this->EstimatePositions[k], 1, 0,
                &this->EstimateValues[k]);
  }
}

PsnrEstimate StreamedVolume::estimate(std::int64_t voxels) const
{
  std::vector<float> targets;
  for (std::int64_t k = 0; k < voxels; ++k) {
    targets.push_back(NormalisedTarget(this->EstimateValues[static_cast<std::size_t>(k)],
                                       this->Statistics.low, this->Statistics.high));
  }
  return {{this->EstimatePositions.begin(), this->EstimatePositions.begin() + voxels},
          std::move(targets)};
}

SamplePool& StreamedVolume::begin(double rereads)
{
  this->Pool.begin(this->Statistics.low, this->Statistics.high, rereads);
  return this->Pool;
}

double StreamedVolume::mostRereads() const
{
  const double once = this->Blocks.readShare();
  const double measured = this->measuresAll()
                              ? 1.0
                              : static_cast<double>(this->MeasuredVoxels + VoxelsOfBar) /
                                    static_cast<double>(Voxels(this->Reader.dims()));
  return std::clamp((MostReadings - measured - once) / once, 0.0, 1.0);
}

void StreamedVolume::requireKnownRange(const VolumePiece& piece, const VoxelBox& box) const
{
  const VolumeStatistics now = MeasureBox(piece, box, this->Threads);
  if (now.low < this->Statistics.low || now.high > this->Statistics.high) {
    throw Error(ErrorCode::InvalidArgument,
                "the data changed while they were read: voxels " + ToText(box) + " were within " +
                    ToText(this->Statistics.low) + " to " + ToText(this->Statistics.high) +
                    " and now are " + ToText(now.low) + " to " + ToText(now.high));
  }
}

void StreamedVolume::readAgain()
{
  const std::optional<std::int64_t> block = this->Pool.wanted();
  if (!block) {
    return;
  }
  const VolumePiece piece = this->read(this->Blocks.voxels(*block));
  this->requireKnownRange(piece, this->Blocks.ownVoxels(*block));
  this->Pool.offer(*block, this->Pool.sample(*block, 1, piece, this->Threads));
}

DecodedReport StreamedVolume::measure(const Evaluator& evaluator, const Model& model,
                                      const Progress& progress)
{
  const bool all = this->measuresAll();
  const BlockGrid boxes(this->Reader.dims(),
                        std::min(this->BlockVoxels, all ? VoxelsOfMeasuredBlock : VoxelsOfBar));
  const double share =
      static_cast<double>(this->MeasuredVoxels) / static_cast<double>(Voxels(this->Reader.dims()));
  const std::int64_t count =
      all ? boxes.count() : std::llround(std::ceil(share * static_cast<double>(boxes.count())));
  QualityMeter meter(evaluator, model.volume, this->Threads, BandSize(model.description));
  std::optional<CellRanges> decoded;
  if (all) {
    decoded.emplace(this->Reader.dims(), this->MacroCellSize);
  }
  std::int64_t done = 0;
  for (const std::int64_t box : ChooseBars(boxes.count(), count, this->Seed)) {
    const VoxelBox own = boxes.ownVoxels(box);
    if (own.voxels() > 0) {
      const VolumePiece piece = this->read(own);
      this->requireKnownRange(piece, own);
      meter.add(piece, all ? &*decoded : nullptr, [&](double part) {
        progress((static_cast<double>(done) + part) / static_cast<double>(count));
      });
    }
    ++done;
  }
  Quality quality = meter.quality();
  if (all) {
    return {quality, decoded->cells(0.0, 1.0, 0.0, MacroCellProvenance::Decoded)};
  }
  quality.sampledVoxels = static_cast<std::uint64_t>(meter.errors().voxels);
  return {quality, this->Ranges.cells(model.volume.low, model.volume.high, meter.errors().largest,
                                      MacroCellProvenance::Training)};
}

} // namespace inr
