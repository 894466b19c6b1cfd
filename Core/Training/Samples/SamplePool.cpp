// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/SamplePool.h"

#include "Core/Training/Runtime/LearningRate.h"
#include "Core/Training/Samples/RandomStream.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numeric>
#include <sstream>
#include <string>

namespace inr {

namespace {

/// Blocks that are read before they are due, so that the training does not wait for the disk.
constexpr std::int64_t ReadAhead = 4;

constexpr std::chrono::milliseconds Moment{50};

/// Samples of a block, so that the pool is as large as can be: a power of two.
std::int64_t SamplesPerBlock(std::int64_t blocks, std::int64_t mostSamples)
{
  std::int64_t samples = std::max<std::int64_t>(1, BatchSize / blocks);
  while (2 * samples * blocks <= mostSamples) {
    samples *= 2;
  }
  return samples;
}

std::vector<std::int64_t> Shuffled(std::int64_t count, std::uint64_t stream)
{
  std::vector<std::int64_t> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::int64_t k = count - 1; k > 0; --k) {
    const std::uint64_t other = RandomBits(stream, static_cast<std::uint64_t>(k));
    std::swap(order[static_cast<std::size_t>(k)], order[other % static_cast<std::uint64_t>(k + 1)]);
  }
  return order;
}

} // namespace

std::int64_t CountDifferences(const double* a, const double* b, std::int64_t count,
                              double tolerance)
{
  std::int64_t differing = 0;
  for (std::int64_t k = 0; k < count; ++k) {
    const bool same = a[k] == b[k] || std::abs(a[k] - b[k]) <= tolerance ||
                      (std::isnan(a[k]) && std::isnan(b[k]));
    differing += same ? 0 : 1;
  }
  return differing;
}

SamplePool::SamplePool(const BlockGrid& blocks, std::int64_t mostSamples, std::uint64_t seed,
                       const BlockShare& share)
    : Blocks(blocks), Seed(seed), Share(share),
      Boxes(HalveLongest(blocks.dims(), glm::dvec3(blocks.dims()) * glm::dvec3(blocks.extent()),
                         SamplesPerBlock(blocks.count(), mostSamples))),
      Values(static_cast<std::size_t>(share.blocks() * this->Boxes.count()),
             std::numeric_limits<double>::quiet_NaN()),
      Rounds(static_cast<std::size_t>(share.blocks()))
{}

glm::vec3 SamplePool::position(std::int64_t block, std::uint32_t round, std::int64_t sample) const
{
  const std::uint64_t stream =
      RandomBits(StreamSeed(this->Seed, RandomStream::PoolPositions), round);
  const auto number = static_cast<std::uint64_t>(block * this->Boxes.count() + sample);
  const glm::vec3& extent = this->Blocks.extent();
  const glm::vec3 corner =
      this->Blocks.corner(block) + this->Boxes.corners[static_cast<std::size_t>(sample)] * extent;
  const glm::vec3 position =
      PositionInBox(corner, this->Boxes.extent * extent, this->Blocks.dims(), stream, number);
  // Half of them in voxels' centres, as StratifiedPositions have it.
  const bool free = (number + round) % 2 == 0;
  return free ? position : VoxelCentre(position, this->Blocks.dims());
}

std::vector<double> SamplePool::sample(std::int64_t block, std::uint32_t round,
                                       const VolumePiece& piece, const Arena& arena) const
{
  constexpr std::int64_t share = 4096;
  std::vector<double> values(static_cast<std::size_t>(this->Boxes.count()));
  arena.forEachBlock(this->Boxes.count(), share, [&](std::int64_t begin, std::int64_t end) {
    std::vector<glm::vec3> positions;
    for (std::int64_t k = begin; k < end; ++k) {
      positions.push_back(this->position(block, round, k));
    }
    SamplePiece(piece, this->Blocks.dims(), positions.data(), end - begin, this->Origin,
                &values[begin]);
  });
  return values;
}

std::string SamplePool::name() const
{
  std::ostringstream text;
  text << "a pool of " << this->samples() << " of " << this->Blocks.count() << " blocks";
  if (this->Origin != 0) {
    text << " above " << std::setprecision(std::numeric_limits<double>::max_digits10)
         << this->Origin;
  }
  return text.str();
}

void SamplePool::put(std::int64_t block, const std::vector<double>& values)
{
  std::copy(values.begin(), values.end(), &this->Values[this->place(block)]);
}

StateArrays SamplePool::state()
{
  const auto bytes = [](const auto& values) {
    return static_cast<std::int64_t>(values.size() * sizeof(values[0]));
  };
  return {{"samples", this->Values.data(), bytes(this->Values)},
          {"rounds", this->Rounds.data(), bytes(this->Rounds)},
          {"reread", &this->Used, sizeof(this->Used)}};
}

bool SamplePool::resume()
{
  const auto again = std::count(this->Rounds.begin(), this->Rounds.end(), 1u);
  const auto first = std::count(this->Rounds.begin(), this->Rounds.end(), 0u);
  this->Asked = this->Used;
  return this->Used == again && again + first == this->Share.blocks();
}

std::int64_t SamplePool::differences(std::int64_t block, const VolumePiece& piece, double tolerance,
                                     const Arena& arena) const
{
  const std::uint32_t round =
      this->Rounds[static_cast<std::size_t>(block - this->Share.firstBlock)];
  const std::vector<double> now = this->sample(block, round, piece, arena);
  return CountDifferences(now.data(), &this->Values[this->place(block)], this->Boxes.count(),
                          tolerance);
}

void SamplePool::begin(double low, double high, double rereads)
{
  this->Low = low - this->Origin;
  this->High = high - this->Origin;
  this->Order = Shuffled(this->Share.blocks(), StreamSeed(this->Seed, RandomStream::PoolOrder));
  for (std::int64_t& block : this->Order) {
    block += this->Share.firstBlock;
  }
  this->Order.resize(static_cast<std::size_t>(this->Share.mostBlocks), NoBlock);
  this->Order.resize(static_cast<std::size_t>(rereads * static_cast<double>(this->Order.size())));
}

std::optional<std::int64_t> SamplePool::wanted()
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  const auto isWanted = [this] {
    return this->Asked < static_cast<std::int64_t>(this->Order.size()) && this->Due > 0 &&
           this->Asked < this->Due + ReadAhead;
  };
  if (!this->Changed.wait_for(lock, Moment, isWanted)) {
    return std::nullopt;
  }
  return this->Order[static_cast<std::size_t>(this->Asked++)];
}

std::optional<std::int64_t> SamplePool::owed(const TrainingStep& step)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  if (this->Asked >= this->due(step)) {
    return std::nullopt;
  }
  return this->Order[static_cast<std::size_t>(this->Asked++)];
}

void SamplePool::offer(std::int64_t block, std::vector<double> values)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Waiting.push_back({block, std::move(values)});
  this->Changed.notify_all();
}

/// Blocks that were read again when a step begins: none while the learning rate is constant, since
/// by then it may not be known how many steps there will be.
std::int64_t SamplePool::due(const TrainingStep& step) const
{
  const std::uint64_t constant = step.planned / LearningRate::ConstantShare;
  if (step.number <= constant) {
    return 0;
  }
  const double share = static_cast<double>(step.number - constant) /
                       static_cast<double>(std::max(step.planned - constant, std::uint64_t{1}));
  const auto blocks = static_cast<double>(this->Order.size());
  return static_cast<std::int64_t>(std::ceil(std::min(share, 1.0) * blocks));
}

void SamplePool::prepare(const TrainingStep& step, const StopCheck& check)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  this->Due = this->due(step);
  this->Changed.notify_all();
  while (this->Used < this->Due) {
    if (!this->Waiting.empty()) {
      this->use(this->Waiting.front());
      this->Waiting.pop_front();
      continue;
    }
    this->Changed.wait_for(lock, Moment);
    lock.unlock(); // the reader is not to wait for what the user is asked
    if (!check.goesOn()) {
      return;
    }
    lock.lock();
  }
}

void SamplePool::use(const Offer& offer)
{
  if (offer.block != NoBlock) {
    this->put(offer.block, offer.values);
    this->Rounds[static_cast<std::size_t>(offer.block - this->Share.firstBlock)] = 1;
  }
  ++this->Used;
}

void SamplePool::draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin,
                      std::int64_t end, glm::vec3* positions, float* targets) const
{
  const std::int64_t perBlock = this->Boxes.count();
  const std::int64_t perItem = this->samples() / BatchSize; // a power of two
  const auto first = step * static_cast<std::uint64_t>(this->total());
  for (std::int64_t k = begin; k < end; ++k) {
    const std::int64_t batch = k / this->Share.items();
    const std::int64_t item = this->Share.firstItem + k % this->Share.items();
    const std::uint64_t drawn = first + static_cast<std::uint64_t>(batch * BatchSize + item);
    const std::uint64_t within = RandomBits(stream, drawn) % static_cast<std::uint64_t>(perItem);
    const std::int64_t number = item * perItem + static_cast<std::int64_t>(within);
    const std::int64_t block = number / perBlock;
    const std::int64_t own = block - this->Share.firstBlock;
    const std::uint32_t round = this->Rounds[static_cast<std::size_t>(own)];
    positions[k - begin] = this->position(block, round, number % perBlock);
    const double value =
        this->Values[this->place(block) + static_cast<std::size_t>(number % perBlock)];
    targets[k - begin] = NormalisedTarget(value, this->Low, this->High);
  }
}

} // namespace inr
