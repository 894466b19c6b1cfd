// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickCache.h"

#include "Core/Error.h"

#include <algorithm>
#include <limits>
#include <string>

namespace inr {

namespace {
constexpr std::int64_t FewestBricks = 8;
}

std::int64_t BrickCache::bytesFor(const Hierarchy& hierarchy, CachePrecision precision,
                                  std::int64_t bricks)
{
  const auto perSlot =
      static_cast<std::int64_t>(sizeof(BrickKey) + sizeof(std::uint64_t) + sizeof(std::int32_t));
  return BrickPool::bytesFor(precision, hierarchy.voxelsPerBrick(), bricks) +
         PageTable::bytesFor(bricks) + bricks * perSlot;
}

std::int64_t BrickCache::capacityFor(const Hierarchy& hierarchy, CachePrecision precision,
                                     std::int64_t bytes)
{
  // More than the volume has would stay empty.
  std::int64_t most = 0;
  constexpr std::int64_t enough = std::numeric_limits<std::int32_t>::max() / 64;
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

void BrickCache::beginFrame()
{
  ++this->Frame;
  this->CandidatesKnown = false;
}

void BrickCache::findCandidates()
{
  this->Candidates.clear();
  const auto slots = static_cast<std::int32_t>(this->capacity());
  for (std::int32_t slot = 0; slot < slots; ++slot) {
    if (this->LastUse[static_cast<std::size_t>(slot)] < this->Frame) {
      this->Candidates.push_back(slot);
    }
  }
  const auto older = [this](std::int32_t a, std::int32_t b) {
    const std::uint64_t usedA = this->LastUse[static_cast<std::size_t>(a)];
    const std::uint64_t usedB = this->LastUse[static_cast<std::size_t>(b)];
    return usedA != usedB ? usedA > usedB : a > b;
  };
  std::sort(this->Candidates.begin(), this->Candidates.end(), older);
  this->CandidatesKnown = true;
}

std::int32_t BrickCache::freeSlot()
{
  if (!this->CandidatesKnown) {
    this->findCandidates();
  }
  while (!this->Candidates.empty()) {
    const std::int32_t slot = this->Candidates.back();
    this->Candidates.pop_back();
    if (this->LastUse[static_cast<std::size_t>(slot)] < this->Frame) { // not touched since
      return slot;
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
