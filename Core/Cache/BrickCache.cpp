// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickCache.h"

#include "Core/Error.h"
#include "Core/GridBox.h"
#include "Core/Random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>
#include <string>

namespace inr {

namespace {
constexpr auto Word = static_cast<std::int64_t>(sizeof(std::uint64_t));

/// Hundredths, so that what is said to be enough is.
std::string InHundredths(std::int64_t bytes, double (*round)(double))
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2)
       << round(static_cast<double>(bytes) * 100 / (1 << 20)) / 100;
  return text.str();
}

std::string SizeOf(const glm::ivec3& voxels)
{
  return std::to_string(voxels.x) + " x " + std::to_string(voxels.y) + " x " +
         std::to_string(voxels.z);
}
} // namespace

std::int64_t BrickCache::bytesPerBrick(const Hierarchy& hierarchy, CachePrecision precision)
{
  return BrickPool::bytesPerSlot(precision, hierarchy.voxelsPerBrick()) +
         BrickBlocks::bytesPerSlot(hierarchy.brickDims()) + PageTable::bytesFor(1) -
         PageTable::bytesFor(0) + 3 * Word; // owner, arrival, last use
}

std::int64_t BrickCache::bytesFor(std::int64_t bricks) const
{
  // Candidates keep the memory that they have once had.
  return PageTable::bytesFor(0) + this->Capacity * Word +
         bricks * bytesPerBrick(this->Levels, this->precision());
}

std::int64_t BrickCache::capacityFor(const Hierarchy& hierarchy, CachePrecision precision,
                                     std::int64_t bytes)
{
  // More than the volume has would stay empty.
  std::int64_t most = 0;
  constexpr std::int64_t enough = (std::int64_t{1} << SlotBits) - 1;
  for (int level = 0; level < hierarchy.levels() && most < enough; ++level) {
    const glm::i64vec3& bricks = hierarchy.bricks(level);
    most += GridCount(bricks);
  }
  const std::int64_t each = bytesPerBrick(hierarchy, precision) + Word;
  const std::int64_t capacity = (bytes - PageTable::bytesFor(0)) / each;
  if (capacity < FewestBricks) {
    refuse(hierarchy, "", bytes, PageTable::bytesFor(0) + FewestBricks * each);
  }
  return std::min({capacity, std::max(most, FewestBricks), enough});
}

void BrickCache::refuse(const Hierarchy& hierarchy, const char* where, std::int64_t bytes,
                        std::int64_t least)
{
  throw Error(ErrorCode::InvalidArgument,
              "a cache of " + InHundredths(bytes, std::floor) + " MiB " + where + "does not hold " +
                  std::to_string(FewestBricks) + " bricks of " + SizeOf(hierarchy.brickDims()) +
                  " voxels and what goes with them; make it at "
                  "least " +
                  InHundredths(least, std::ceil) + " MiB large, or the bricks smaller");
}

BrickCache::BrickCache(const Hierarchy& hierarchy, CachePrecision precision, std::int64_t bytes)
    : Levels(hierarchy), Capacity(capacityFor(hierarchy, precision, bytes)),
      Pool(precision, hierarchy.voxelsPerBrick(), this->Capacity),
      Blocks(precision, hierarchy.brickDims(), this->Capacity), Table(this->Capacity),
      Owners(this->Capacity), Arrivals(this->Capacity), LastUse(this->Capacity)
{
  this->Candidates.reserve(static_cast<std::size_t>(this->Capacity)); // within the budget
}

std::int64_t BrickCache::usedInFrame() const
{
  const auto isUsed = [this](const std::atomic<std::uint64_t>& use) { return use >= this->Frame; };
  return std::count_if(this->LastUse.data(), this->LastUse.data() + this->mapped(), isUsed);
}

void BrickCache::touchThoseSince(std::uint64_t frame)
{
  for (std::int32_t slot = 0; slot < this->mapped(); ++slot) {
    if (this->lastUse(slot) >= frame) {
      this->touch(slot);
    }
  }
}

// The first few per cent of all that can be evicted, from a sample drawn by a fixed rule: sorting
// all of them would take longer than a frame may wait.
std::uint64_t BrickCache::lastCandidate(std::uint64_t frame) const
{
  constexpr std::int64_t samples = 2048;
  const std::int64_t stride = this->mapped() / samples;
  if (stride < 2) {
    return ~std::uint64_t{0};
  }
  std::array<std::uint64_t, samples> sample; // whoever needs a place may have no memory to ask for
  std::size_t count = 0;
  for (std::int64_t k = 0; k < samples; ++k) {
    // Not evenly: what is in use may be, too.
    const std::uint64_t within = MixBits(static_cast<std::uint64_t>(k));
    const auto offset = static_cast<std::int64_t>(within % static_cast<std::uint64_t>(stride));
    const auto slot = static_cast<std::int32_t>(k * stride + offset);
    if (this->lastUse(slot) < frame) {
      sample[count++] = this->candidate(slot);
    }
  }
  const std::size_t wanted =
      static_cast<std::size_t>(std::max<std::int64_t>(samples / 32, 1024 / stride));
  if (count <= wanted) {
    return ~std::uint64_t{0};
  }
  const auto last = sample.begin() + static_cast<std::ptrdiff_t>(wanted);
  std::nth_element(sample.begin(), last, sample.begin() + static_cast<std::ptrdiff_t>(count));
  return *last;
}

void BrickCache::findCandidates(std::uint64_t frame)
{
  const std::uint64_t last = this->lastCandidate(frame);
  const auto slots = static_cast<std::int32_t>(this->mapped());
  for (std::int32_t slot = 0; slot < slots; ++slot) {
    const std::uint64_t candidate = this->candidate(slot);
    if (candidate <= last && this->lastUse(slot) < frame) {
      this->Candidates.push_back(candidate);
    }
  }
  std::sort(this->Candidates.begin(), this->Candidates.end(), std::greater<>());
}

/// The slot to be evicted next, whose candidate is then the list's last; -1 when there is none.
std::int32_t BrickCache::oldest(std::uint64_t frame)
{
  constexpr std::uint64_t slotMask = (std::uint64_t{1} << SlotBits) - 1;
  while (this->NoneBefore < frame) {
    while (!this->Candidates.empty()) {
      const std::uint64_t candidate = this->Candidates.back();
      const auto slot = static_cast<std::int32_t>(candidate & slotMask);
      if (slot < this->mapped() && this->candidate(slot) == candidate) { // not used since
        return this->lastUse(slot) < frame ? slot : -1;
      }
      this->Candidates.pop_back();
    }
    this->findCandidates(frame);
    if (this->Candidates.empty()) {
      this->NoneBefore = frame;
    }
  }
  return -1;
}

std::uint64_t BrickCache::oldestUse(std::uint64_t frame)
{
  const std::int32_t slot = this->oldest(frame);
  return slot < 0 ? Pinned : this->lastUse(slot);
}

void BrickCache::unmap(std::int32_t slot)
{
  this->Candidates.pop_back();
  this->LostUse = std::max(this->LostUse, this->lastUse(slot));
  this->Table.unmap(this->Owners[slot]);
}

void BrickCache::fill(std::int32_t slot, const BrickPart& part, const float* values,
                      const ValueRange& within)
{
  this->Arrivals[slot] = ++this->Arrived;
  this->Pool.store(slot, values, within);
  this->Blocks.store(slot, this->Pool.view(slot), part.blocks, within);
}

void BrickCache::map(std::int32_t slot, const BrickPart& part, const float* values,
                     const ValueRange& within)
{
  this->Owners[slot] = part.key;
  this->fill(slot, part, values, within);
  this->Table.map(part.key, slot);
  this->LastUse[slot].store(this->Frame, std::memory_order_relaxed);
  this->NoneBefore = std::min(this->NoneBefore, this->Frame);
}

bool BrickCache::lacks(const BrickPart& part) const
{
  const std::int32_t slot = this->find(part.key);
  if (slot == PageTable::Unmapped) {
    return true;
  }
  const BlockSet& known = this->Blocks.known(slot);
  return part.blocks.contains(known) && !(part.blocks == known);
}

bool BrickCache::insert(const BrickPart& part, const float* values, const ValueRange& within)
{
  const std::int32_t present = this->find(part.key);
  if (present != PageTable::Unmapped) {
    this->fill(present, part, values, within);
    this->touch(present);
    return true;
  }
  if (this->mapped() == this->Capacity) {
    return this->replace(part, values, within);
  }
  this->Table.makeRoomForOne();
  const auto slot = static_cast<std::int32_t>(this->mapped());
  this->resize(slot + 1);
  this->map(slot, part, values, within);
  return true;
}

bool BrickCache::replace(const BrickPart& part, const float* values, const ValueRange& within)
{
  this->Table.makeRoomForOne(); // before a brick goes for this one
  const std::int32_t slot = this->oldest(this->Frame);
  if (slot >= 0) {
    this->unmap(slot);
    this->map(slot, part, values, within);
  }
  return slot >= 0;
}

void BrickCache::evict(std::uint64_t frame)
{
  const std::int32_t slot = this->oldest(frame);
  const auto last = static_cast<std::int32_t>(this->mapped() - 1);
  this->unmap(slot);
  if (slot != last) {
    this->move(last, slot);
  }
  this->resize(last);
}

void BrickCache::move(std::int32_t from, std::int32_t to)
{
  const std::uint64_t before = this->candidate(from);
  this->Pool.copy(from, to);
  this->Blocks.copy(from, to);
  this->Arrivals[to] = this->Arrivals[from];
  this->Owners[to] = this->Owners[from];
  this->LastUse[to].store(this->lastUse(from), std::memory_order_relaxed);
  this->Table.move(this->Owners[to], to);
  const auto place = [this](std::uint64_t candidate) {
    return std::lower_bound(this->Candidates.begin(), this->Candidates.end(), candidate,
                            std::greater<>());
  };
  const auto known = place(before);
  if (known != this->Candidates.end() && *known == before) {
    this->Candidates.erase(known);
    this->Candidates.insert(place(this->candidate(to)), this->candidate(to));
  }
}

void BrickCache::resize(std::int64_t slots)
{
  this->Pool.resize(slots);
  this->Blocks.resize(slots);
  this->Owners.resize(slots);
  this->Arrivals.resize(slots);
  this->LastUse.resize(slots);
}

void BrickCache::pin(BrickKey key) { this->LastUse[this->find(key)] = Pinned; }

} // namespace inr
