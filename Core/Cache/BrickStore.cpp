// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickStore.h"

#include "Core/Error.h"
#include "Core/Timer.h"

#include <algorithm>
#include <new>
#include <utility>

namespace inr {

namespace {

/// Bricks inferred in one go, outside of the memory of caches; time and abort are looked at in
/// between. Large ones have layers enough for all threads.
std::int64_t BricksAtOnce(const BrickSource& source)
{
  constexpr std::int64_t large = std::int64_t{1} << 18; // voxels
  const std::int64_t enough = source.hierarchy().voxelsPerBrick() < large ? 2 : 1;
  return std::max(source.bricksAtOnce(), enough);
}

/// Bricks in the loader's queue at most, 0 where there is no room for more than one.
std::int64_t LongestQueueIn(const Hierarchy& hierarchy, std::int64_t bytes)
{
  constexpr std::int64_t enough = 64;
  const std::int64_t room = bytes / 8 / BrickLoader::bytesFor(hierarchy, 1);
  return room > 1 ? std::min(room, enough) : 0;
}

} // namespace

BrickStore::BrickStore(std::shared_ptr<CacheBudget> budget,
                       std::shared_ptr<const BrickSource> source, CachePrecision precision,
                       std::int64_t bytes, bool background, int threads)
    : Budget(std::move(budget)), Source(std::move(source)), Limit(bytes),
      LongestQueue(background ? LongestQueueIn(this->Source->hierarchy(), bytes) : 0),
      Loader(this->LongestQueue > 0 ? std::make_unique<BrickLoader>(this->Source, threads, 0)
                                    : nullptr),
      Cache(this->Source->hierarchy(), precision,
            bytes - BrickLoader::bytesFor(this->Source->hierarchy(), this->LongestQueue))
{
  const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
  this->Budget->Stores.push_back(this);
  this->Budget->settle();
}

BrickStore::~BrickStore()
{
  {
    const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
    std::vector<BrickStore*>& stores = this->Budget->Stores;
    stores.erase(std::find(stores.begin(), stores.end(), this));
    this->Budget->settle();
  }
  this->Budget->TurnEnded.notify_all(); // there may be room now
}

std::int64_t BrickStore::mapped() const
{
  const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
  return this->Cache.mapped();
}

std::int64_t BrickStore::capacity() const
{
  const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
  const std::int64_t room =
      this->Budget->roomFor(*this) - this->queueBytes() - this->Cache.bytesFor(0);
  const std::int64_t bricks = room / (this->Cache.bytesFor(1) - this->Cache.bytesFor(0));
  return std::clamp(bricks, BrickCache::FewestBricks, this->Cache.capacity());
}

std::uint64_t BrickStore::beginFrame(std::optional<std::uint64_t> continued)
{
  const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
  this->Cache.beginFrame(++this->Budget->Clock);
  if (continued) {
    this->Cache.touchThoseSince(*continued);
  }
  return this->Cache.frame();
}

bool BrickStore::hasLostSince(std::uint64_t frame) const
{
  return std::max(this->Cache.lostUse(), this->LostQueue) >= frame;
}

/// Makes whole bricks of those that are mapped, and where the source has no others.
void BrickStore::completeKnown(std::vector<BrickPart>& parts) const
{
  for (BrickPart& part : parts) {
    if (!this->Source->infersParts() || this->Cache.find(part.key) != PageTable::Unmapped) {
      part.blocks = BlockSet::all();
    }
  }
}

BrickStore::Loaded BrickStore::load(std::vector<BrickPart> parts, const Arena& arena,
                                    const std::function<bool()>& keepGoing)
{
  this->completeKnown(parts);
  this->forgetRequests();
  const std::int64_t voxels = this->Cache.hierarchy().voxelsPerBrick();
  const auto count = static_cast<std::int64_t>(parts.size());
  const std::int64_t atOnce = BricksAtOnce(*this->Source);
  std::vector<float> values(static_cast<std::size_t>(atOnce * voxels));
  for (std::int64_t first = 0; first < count; first += atOnce) {
    if (first > 0 && keepGoing && !keepGoing()) { // never without progress
      return {first, false};
    }
    const std::int64_t batch = std::min(atOnce, count - first);
    this->Source->inferParts(parts.data() + first, batch, values.data(), arena);
    for (std::int64_t k = first; k < first + batch; ++k) {
      this->countInferred(parts[static_cast<std::size_t>(k)]);
    }
    for (std::int64_t k = 0; k < batch; ++k) {
      const BrickPart& part = parts[static_cast<std::size_t>(first + k)];
      if (!this->insert(part, values.data() + k * voxels)) {
        return {first + k, true};
      }
    }
  }
  return {count, false};
}

void BrickStore::clear()
{
  const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
  while (this->Cache.oldestUse(BrickCache::Pinned) != BrickCache::Pinned) {
    this->Cache.evict(BrickCache::Pinned);
  }
}

void BrickStore::loadFor(double seconds, std::vector<BrickPart> parts, const Arena& arena)
{
  if (!this->makeQueue(static_cast<std::int64_t>(parts.size()))) {
    const Timer timer(seconds);
    this->load(std::move(parts), arena, [&] { return timer.left() > 0; });
    return;
  }
  this->completeKnown(parts);
  this->Loader->request(parts);
  if (!parts.empty()) {
    this->Loader->loadFor(seconds);
    this->mapLoaded();
  }
}

void BrickStore::forgetRequests()
{
  if (this->Loader) {
    this->Loader->request({});
  }
}

void BrickStore::setPaused(bool paused)
{
  if (this->Loader) {
    paused ? this->Loader->pause() : this->Loader->resume();
  }
}

void BrickStore::mapLoaded()
{
  this->Loader->handOver([this](const BrickPart& part, const float* values) {
    this->countInferred(part);
    if (this->Cache.lacks(part)) {
      try {
        this->insert(part, values);     // or not, where all is in use
      } catch (const std::bad_alloc&) { // nor without memory: who wants it asks again
      }
    }
  });
}

void BrickStore::countInferred(const BrickPart& part)
{
  this->Done.add({1, this->Source->points(part), 0});
}

bool BrickStore::insert(const BrickPart& part, const float* values)
{
  const bool inserted = this->makeRoomAndInsert(part, values);
  const std::int64_t bytes =
      this->Cache.hierarchy().voxelsPerBrick() * BytesPerVoxel(this->Cache.precision());
  this->Done.bytes += inserted ? bytes : 0;
  return inserted;
}

bool BrickStore::makeRoomAndInsert(const BrickPart& part, const float* values)
{
  const ValueRange within = this->Source->rangeOf(part.key);
  const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
  if (this->Cache.find(part.key) != PageTable::Unmapped) {
    return this->Cache.insert(part, values, within);
  }
  const std::int64_t mapped = this->Cache.mapped();
  if (mapped >= this->Cache.capacity()) {
    return this->Cache.replace(part, values, within);
  }
  const std::int64_t more = this->Cache.bytesFor(mapped + 1) - this->Cache.bytes();
  while (mapped >= BrickCache::FewestBricks && !this->Budget->fits(more)) {
    BrickStore* const oldest = this->Budget->oldest(this);
    if (oldest == nullptr || oldest == this) {
      return this->Cache.replace(part, values, within);
    }
    oldest->giveOldest();
  }
  return this->Cache.insert(part, values, within);
}

/// Room for so many bricks in the loader's queue, or as many as there may be; false when there is
/// none.
bool BrickStore::makeQueue(std::int64_t bricks)
{
  if (!this->Loader) {
    return false;
  }
  const std::lock_guard<std::mutex> lock(this->Budget->Mutex);
  const std::int64_t wanted = std::min(this->LongestQueue, this->Loader->held() + bricks);
  const std::int64_t more = BrickLoader::bytesFor(this->Source->hierarchy(), 1);
  while (this->Queue < wanted) {
    BrickStore* const oldest = this->Budget->fits(more) ? nullptr : this->Budget->oldest(this);
    if (oldest != nullptr) {
      oldest->giveOldest();
    } else if (this->Budget->fits(more)) {
      ++this->Queue;
    } else {
      break;
    }
  }
  this->Loader->allow(this->Queue);
  return this->Queue > 0;
}

std::int64_t BrickStore::queueBytes() const
{
  return BrickLoader::bytesFor(this->Source->hierarchy(), this->Queue);
}

std::int64_t BrickStore::least() const { return this->Cache.bytesFor(BrickCache::FewestBricks); }

std::int64_t BrickStore::kept() const
{
  return this->queueBytes() +
         this->Cache.bytesFor(std::max(BrickCache::FewestBricks, this->Cache.mapped()));
}

std::int64_t BrickStore::cannotGive() const
{
  if (this->isInUse()) {
    return this->kept();
  }
  const std::int64_t begun = this->Loader ? this->Loader->begun() : 0;
  return this->least() + BrickLoader::bytesFor(this->Source->hierarchy(), begun);
}

bool BrickStore::mayGiveQueue() const
{
  return !this->isInUse() && this->Loader && this->Queue > this->Loader->begun();
}

/// The frame before which bricks may go.
std::uint64_t BrickStore::evictableBefore() const
{
  return this->isInUse() ? this->Cache.frame() : BrickCache::Pinned;
}

std::uint64_t BrickStore::oldestBrickUse()
{
  return this->Cache.mapped() > BrickCache::FewestBricks
             ? this->Cache.oldestUse(this->evictableBefore())
             : BrickCache::Pinned;
}

std::uint64_t BrickStore::oldestUse()
{
  const std::uint64_t brick = this->oldestBrickUse();
  return this->mayGiveQueue() ? std::min(brick, this->Cache.frame()) : brick;
}

void BrickStore::giveOldest()
{
  const std::uint64_t brick = this->oldestBrickUse();
  // The queue is for the latest frame, and what that has used is worth more.
  if (brick >= this->Cache.frame() && this->mayGiveQueue()) {
    this->Loader->giveUp();
    this->Queue = this->Loader->held();
    this->LostQueue = this->Cache.frame();
  } else if (brick < BrickCache::Pinned) {
    this->Cache.evict(this->evictableBefore());
  } // else the loader has begun with the queue since oldestUse was asked
}

namespace {

thread_local int AwaitedDepth = 0;

} // namespace

BrickStore::Awaited::Awaited() { ++AwaitedDepth; }
BrickStore::Awaited::~Awaited() { --AwaitedDepth; }
bool BrickStore::Awaited::here() { return AwaitedDepth > 0; }

BrickStore::Call::Turn::Turn(BrickStore& store) : Store(store)
{
  const auto self = std::this_thread::get_id();
  CacheBudget& budget = *store.Budget;
  std::unique_lock<std::mutex> lock(budget.Mutex);
  const auto isInUse = [](const BrickStore* other) { return other->isInUse(); };
  const auto isInUseHere = [self](const BrickStore* other) { return other->User == self; };
  const bool isWithinACall =
      Awaited::here() || std::any_of(budget.Stores.begin(), budget.Stores.end(), isInUseHere);
  if (store.isInUse() && isWithinACall) {
    throw Error(ErrorCode::Cancelled, "rendering from a cache that is in use by a picture in the "
                                      "making, which waits for this one");
  }
  budget.TurnEnded.wait(lock, [&] {
    return !store.isInUse() && (isWithinACall || budget.fits(0) ||
                                std::none_of(budget.Stores.begin(), budget.Stores.end(), isInUse));
  });
  store.User = self;
  budget.beginCall();
  this->Before = store.Done;
}

BrickStore::Call::Turn::~Turn()
{
  CacheBudget& budget = *this->Store.Budget;
  {
    const std::lock_guard<std::mutex> lock(budget.Mutex);
    this->Store.User = {};
    budget.endCall();
    budget.settle();
  }
  budget.TurnEnded.notify_all();
}

BrickStore::Call::Call(BrickStore& store, const Arena& arena) : Mine(store)
{
  if (store.Loader) {
    try {
      store.mapLoaded();
    } catch (const std::bad_alloc&) { // between two pictures: this one asks for the same again
    }
  }
  const BrickKey coarsest = store.Cache.hierarchy().coarsest();
  if (store.Cache.find(coarsest) == PageTable::Unmapped) {
    store.load({coarsest}, arena, {});
    store.Cache.pin(coarsest);
  }
}

} // namespace inr
