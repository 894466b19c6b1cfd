// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickStore.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace inr {

namespace {

/// Bricks inferred in one go: they share the threads, and time and abort are looked at in between.
constexpr std::int64_t BricksAtOnce = 2;

/// Null where there is no room for a queue of more than one brick.
std::unique_ptr<BrickLoader> MakeLoader(const std::shared_ptr<const BrickSource>& source,
                                        std::int64_t bytes, int threads)
{
  constexpr std::int64_t enough = 64;
  const std::int64_t room = bytes / 8 / BrickLoader::bytesFor(source->hierarchy(), 1);
  return room > 1 ? std::make_unique<BrickLoader>(source, threads, std::min(room, enough))
                  : nullptr;
}

} // namespace

BrickStore::BrickStore(std::shared_ptr<const BrickSource> source, CachePrecision precision,
                       std::int64_t bytes, bool background, const Arena& arena)
    : Source(std::move(source)),
      Loader(background ? MakeLoader(this->Source, bytes, arena.threads()) : nullptr),
      Cache(this->Source->hierarchy(), precision,
            bytes - (this->Loader ? this->Loader->bytes() : 0))
{
  // There is always something to fall back on.
  const BrickKey coarsest = this->Cache.hierarchy().coarsest();
  this->load({coarsest}, arena, {});
  this->Cache.pin(coarsest);
}

std::int64_t BrickStore::bytes() const
{
  return this->Cache.bytes() + (this->Loader ? this->Loader->bytes() : 0);
}

BrickStore::Loaded BrickStore::load(const std::vector<BrickKey>& keys, const Arena& arena,
                                    const std::function<bool()>& keepGoing)
{
  if (this->Loader) {
    this->Loader->request({});
  }
  const std::int64_t voxels = this->Cache.hierarchy().voxelsPerBrick();
  const auto count = static_cast<std::int64_t>(keys.size());
  std::vector<float> values(static_cast<std::size_t>(BricksAtOnce * voxels));
  for (std::int64_t first = 0; first < count; first += BricksAtOnce) {
    if (first > 0 && keepGoing && !keepGoing()) { // never without progress
      return {first, false};
    }
    const std::int64_t batch = std::min(BricksAtOnce, count - first);
    this->Source->infer(keys.data() + first, batch, values.data(), arena);
    for (std::int64_t k = 0; k < batch; ++k) {
      const BrickKey key = keys[static_cast<std::size_t>(first + k)];
      if (!this->Cache.insert(key, values.data() + k * voxels)) {
        return {first + k, true};
      }
    }
  }
  return {count, false};
}

void BrickStore::loadFor(double seconds, const std::vector<BrickKey>& keys, const Arena& arena)
{
  if (!this->Loader) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    this->load(keys, arena, [&] {
      return std::chrono::duration<double>(Clock::now() - start).count() < seconds;
    });
    return;
  }
  this->Loader->request(keys);
  if (!keys.empty()) {
    this->Loader->loadFor(seconds);
    this->mapLoaded();
  }
}

void BrickStore::mapLoaded()
{
  this->Loader->handOver([this](BrickKey key, const float* values) {
    if (this->Cache.find(key) == PageTable::Unmapped) {
      this->Cache.insert(key, values); // or not, where all is in use
    }
  });
}

BrickStore::Call::Call(BrickStore& store) : Store(store)
{
  if (this->Store.Loader) {
    this->Store.Loader->pause();
    this->Store.mapLoaded();
  }
}

BrickStore::Call::~Call()
{
  if (this->Store.Loader) {
    this->Store.Loader->resume();
  }
}

} // namespace inr
