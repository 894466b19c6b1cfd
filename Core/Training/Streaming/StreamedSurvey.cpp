// SPDX-License-Identifier: BSD-3-Clause
//
// The first reading of a volume, and what a checkpoint keeps of it.
#include "Core/Timer.h"
#include "Core/Training/Samples/RandomStream.h"
#include "Core/Training/Streaming/StreamedVolume.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace inr {

void StreamedVolume::survey(const Progress& progress)
{
  const Timer clock;
  for (std::int64_t k = 0; k < this->Share.mostBlocks; ++k) {
    const std::int64_t block = this->Share.firstBlock + k;
    this->Group.together(
        [&] { progress(static_cast<double>(k) / static_cast<double>(this->Share.mostBlocks)); });
    VolumePiece piece;
    this->Group.together([&] { piece = this->readFirst(block); });
    this->fixOrigin(piece);
    this->Group.together(
        [&] { block < this->Share.endBlock ? this->survey(block, piece) : void(); });
  }
  const std::vector<double> seconds = this->Group.valuesOfAll(clock.seconds());
  this->SurveySeconds = *std::max_element(seconds.begin(), seconds.end());
  const VolumeStatistics own = this->Statistics;
  this->Statistics = VolumeStatistics();
  for (const VolumeStatistics& each : this->Group.valuesOfAll(own)) {
    this->Statistics.add(each);
  }
  if (!this->measuresAll()) {
    this->Ranges.gather(this->Group);
  }
  this->shareEstimates();
}

/// A block of the share, or behind it nothing.
VolumePiece StreamedVolume::readFirst(std::int64_t block)
{
  if (block < this->Share.endBlock) {
    return this->read(this->Blocks.voxels(block));
  }
  this->readNothing();
  return {};
}

/// Numbers of fewer bytes a double holds with room to spare.
bool StreamedVolume::needsOrigin() const
{
  return ScalarSize(this->Reader.type()) == sizeof(double);
}

/// The smallest value of the first blocks that have a finite one will do: what counts is that it is
/// near the others. Before it is known, no sample is finite.
void StreamedVolume::fixOrigin(const VolumePiece& piece)
{
  if (!this->needsOrigin() || this->HasOrigin) {
    return;
  }
  double mine = 0;
  this->Group.together([&] {
    mine = MeasureBox(piece, {piece.first, piece.data.dims}, this->Threads).low;
  });
  for (const double low : this->Group.valuesOfAll(mine)) {
    if (std::isfinite(low)) {
      this->Pool.setOrigin(low);
      this->HasOrigin = true;
      return;
    }
  }
}

void StreamedVolume::survey(std::int64_t block, const VolumePiece& piece)
{
  const GridBox own = this->Blocks.ownVoxels(block);
  this->Statistics.add(MeasureBox(piece, own, this->Threads));
  if (!this->measuresAll()) {
    this->Ranges.add(piece, own, this->Threads);
  }
  this->Pool.put(block, this->Pool.sample(block, 0, piece, this->Threads));
  this->sampleEstimate(block, piece);
}

StateArrays StreamedVolume::state()
{
  // What follows the range is of constant volumes only, which have no checkpoint.
  constexpr std::size_t range = offsetof(VolumeStatistics, overLow);
  StateArrays arrays = {{"range", &this->Statistics, range},
                        {"seconds", &this->SurveySeconds, sizeof(this->SurveySeconds)},
                        {"random", this->EstimateValues.data(),
                         static_cast<std::int64_t>(this->EstimateValues.size() * sizeof(double))}};
  if (!this->measuresAll()) {
    arrays.push_back(this->Ranges.state());
  }
  if (this->needsOrigin()) { // checkpoints of other types have none
    arrays.push_back(this->Pool.originState());
  }
  const StateArrays pool = this->Pool.state();
  arrays.insert(arrays.end(), pool.begin(), pool.end());
  return arrays;
}

bool StreamedVolume::resume()
{
  return this->Pool.resume() && this->Statistics.hasValues() && std::isfinite(this->Pool.origin());
}

bool StreamedVolume::isAsBefore(std::uint64_t number)
{
  constexpr std::int64_t share = 16; // of so many blocks one, and not more than some
  constexpr std::int64_t most = 8;
  const std::uint64_t stream = RandomBits(StreamSeed(this->Seed, RandomStream::KeptBlocks), number);
  const std::int64_t count = std::clamp(this->Share.mostBlocks / share, std::int64_t{1}, most);
  bool same = true;
  for (std::int64_t k = 0; k < count; ++k) {
    this->Group.together([&] { same = this->isAsBefore(stream, k) && same; });
  }
  return this->Group.all(same);
}

/// Of the k-th block of a random choice.
bool StreamedVolume::isAsBefore(std::uint64_t stream, std::int64_t k)
{
  if (this->Share.blocks() == 0) {
    this->readNothing();
    return true;
  }
  const auto blocks = static_cast<std::uint64_t>(this->Share.blocks());
  const std::int64_t block =
      this->Share.firstBlock +
      static_cast<std::int64_t>(RandomBits(stream, static_cast<std::uint64_t>(k)) % blocks);
  const VolumePiece piece = this->read(this->Blocks.voxels(block));
  return this->Pool.differences(block, piece, this->tolerance(), this->Threads) == 0;
}

void StreamedVolume::sampleEstimate(std::int64_t block, const VolumePiece& piece)
{
  for (const std::size_t k : this->EstimatesOfBlocks[static_cast<std::size_t>(block)]) {
    SamplePiece(piece, this->Reader.dims(), &this->EstimatePositions[k], 1, this->Pool.origin(),
                &this->EstimateValues[k]);
  }
}

/// Each process tells the values in its blocks, in an order that all know.
void StreamedVolume::shareEstimates()
{
  const auto numbers = [this](int rank) {
    const BlockShare share(this->Blocks.count(), rank, this->Group.size());
    std::vector<std::size_t> found;
    for (std::int64_t block = share.firstBlock; block < share.endBlock; ++block) {
      const std::vector<std::size_t>& here =
          this->EstimatesOfBlocks[static_cast<std::size_t>(block)];
      found.insert(found.end(), here.begin(), here.end());
    }
    return found;
  };
  std::string mine;
  for (const std::size_t k : numbers(this->Group.rank())) {
    mine.append(reinterpret_cast<const char*>(&this->EstimateValues[k]), sizeof(double));
  }
  const std::vector<std::string> all = this->Group.gather(mine);
  for (int rank = 0; rank < this->Group.size(); ++rank) {
    const char* next = all[static_cast<std::size_t>(rank)].data();
    for (const std::size_t k : numbers(rank)) {
      this->EstimateValues[k] = FromBytes<double>(next);
      next += sizeof(double);
    }
  }
}

} // namespace inr
