// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickCache.h"

#include "Core/Error.h"
#include "Core/Random.h"

#include <algorithm>
#include <functional>
#include <string>

namespace inr {

namespace {
constexpr std::int64_t FewestBricks = 8;
}

std::int64_t BrickCache::bytesFor(const Hierarchy& hierarchy, CachePrecision precision,
                                  std::int64_t bricks)
{
  const auto perSlot =
      static_cast<std::int64_t>(sizeof(BrickKey) + 2 * sizeof(std::uint64_t)); // use, candidate
  return BrickPool::bytesFor(precision, hierarchy.voxelsPerBrick(), bricks) +
         PageTable::bytesFor(bricks) + bricks * perSlot;
}

std::int64_t BrickCache::capacityFor(const Hierarchy& hierarchy, CachePrecision precision,
                                     std::int64_t bytes)
{
  // More than the volume has would stay empty.
  std::int64_t most = 0;
  constexpr std::int64_t enough = (std::int64_t{1} << SlotBits) - 1;
  for (int level = 0; level < hierarchy.levels() && most < enough; ++level) {
    const glm::i64vec3& bricks = hierarchy.bricks(level);
    most += bricks.x * bricks.y * bricks.z;
  }
  std::int64_t low = 0;
  std::int64_t high = std::min(std::max(most, FewestBricks), enough);
  while (low < high) {
    const std::int64_t middle = (low + high + 1) / 2;
    if (bytesFor(hierarchy, precision, middle) <= bytes) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  if (low < FewestBricks) {
    throw Error(ErrorCode::InvalidArgument,
                "a cache of " + std::to_string(bytes) + " bytes does not hold " +
                    std::to_string(FewestBricks) + " bricks; it needs at least " +
                    std::to_string(bytesFor(hierarchy, precision, FewestBricks)) +
                    ", or smaller bricks");
  }
  return low;
}

BrickCache::BrickCache(const Hierarchy& hierarchy, CachePrecision precision, std::int64_t bytes)
    : Levels(hierarchy),
      Pool(precision, hierarchy.voxelsPerBrick(), capacityFor(hierarchy, precision, bytes)),
      Table(this->Pool.slots()), Owners(static_cast<std::size_t>(this->Pool.slots()), NoBrick),
      LastUse(new std::atomic<std::uint64_t>[static_cast<std::size_t>(this->Pool.slots())])
{
  for (std::int64_t slot = 0; slot < this->capacity(); ++slot) {
    this->LastUse[static_cast<std::size_t>(slot)] = 0;
  }
  this->Candidates.reserve(static_cast<std::size_t>(this->capacity())); // within the budget
}

std::int64_t BrickCache::bytes() const
{
  return bytesFor(this->Levels, this->precision(), this->capacity());
}

std::int64_t BrickCache::usedInFrame() const
{
  const auto isUsed = [this](const std::atomic<std::uint64_t>& use) { return use >= this->Frame; };
  return std::count_if(this->LastUse.get(), this->LastUse.get() + this->capacity(), isUsed);
}

void BrickCache::beginFrame() { ++this->Frame; }

// The first few per cent of all that can be evicted, from a sample drawn by a fixed rule: sorting
// all of them would take longer than a frame may wait.
std::uint64_t BrickCache::lastCandidate() const
{
  constexpr std::int64_t samples = 2048;
  const std::int64_t stride = this->capacity() / samples;
  if (stride < 2) {
    return ~std::uint64_t{0};
  }
  std::vector<std::uint64_t> sample;
  for (std::int64_t k = 0; k < samples; ++k) {
    // Not evenly: what is in use may be, too.
    const std::uint64_t within = MixBits(static_cast<std::uint64_t>(k));
    const auto offset = static_cast<std::int64_t>(within % static_cast<std::uint64_t>(stride));
    const auto slot = static_cast<std::int32_t>(k * stride + offset);
    if (this->lastUse(slot) < this->Frame) {
      sample.push_back(this->candidate(slot));
    }
  }
  const std::size_t wanted =
      static_cast<std::size_t>(std::max<std::int64_t>(samples / 32, 1024 / stride));
  if (sample.size() <= wanted) {
    return ~std::uint64_t{0};
  }
  const auto last = sample.begin() + static_cast<std::ptrdiff_t>(wanted);
  std::nth_element(sample.begin(), last, sample.end());
  return *last;
}

void BrickCache::findCandidates()
{
  const std::uint64_t last = this->lastCandidate();
  const auto slots = static_cast<std::int32_t>(this->capacity());
  for (std::int32_t slot = 0; slot < slots; ++slot) {
    const std::uint64_t candidate = this->candidate(slot);
    if (candidate <= last && this->lastUse(slot) < this->Frame) {
      this->Candidates.push_back(candidate);
    }
  }
  std::sort(this->Candidates.begin(), this->Candidates.end(), std::greater<>());
}

std::int32_t BrickCache::freeSlot()
{
  constexpr std::uint64_t slotMask = (std::uint64_t{1} << SlotBits) - 1;
  while (this->ExhaustedIn != this->Frame) {
    while (!this->Candidates.empty()) {
      const std::uint64_t candidate = this->Candidates.back();
      this->Candidates.pop_back();
      const auto slot = static_cast<std::int32_t>(candidate & slotMask);
      if (this->candidate(slot) == candidate) { // not used since
        return slot;
      }
    }
    this->findCandidates();
    if (this->Candidates.empty()) {
      this->ExhaustedIn = this->Frame;
    }
  }
  return -1;
}

bool BrickCache::insert(BrickKey key, const float* values)
{
  const std::int32_t slot = this->freeSlot();
  if (slot < 0) {
    return false;
  }
  BrickKey& owner = this->Owners[static_cast<std::size_t>(slot)];
  if (owner != NoBrick) {
    this->Table.unmap(owner);
    --this->Mapped;
  }
  owner = key;
  this->Pool.store(slot, values);
  this->Table.map(key, slot);
  this->LastUse[static_cast<std::size_t>(slot)] = this->Frame;
  ++this->Mapped;
  return true;
}

void BrickCache::pin(BrickKey key)
{
  this->LastUse[static_cast<std::size_t>(this->find(key))] = Pinned;
}

} // namespace inr
