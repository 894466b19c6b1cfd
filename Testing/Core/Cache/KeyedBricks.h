// SPDX-License-Identifier: BSD-3-Clause
//
// Stores of bricks that can be told from each other by what is in them.
#pragma once

#include "Core/Cache/BrickStore.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>

/// Bricks that tell their key, and how many layers of them were inferred.
class KeyedBricks : public inr::BrickSource
{
public:
  explicit KeyedBricks(int brickSize, std::chrono::milliseconds forALayer = {})
      : BrickSource(inr::Hierarchy({4000, 2, 2}, brickSize)), ForALayer(forALayer)
  {}

  void inferLayer(inr::BrickKey key, std::int64_t, float* values) const override
  {
    std::this_thread::sleep_for(this->ForALayer);
    const std::int64_t voxels = this->hierarchy().voxelsPerBrick() / 2;
    std::fill_n(values, voxels, ValueOf(key));
    ++this->Layers;
  }
  static float ValueOf(inr::BrickKey key) { return static_cast<float>(key % 4096) / 4096; }
  std::int64_t bricks() const { return this->Layers / 2; }

private:
  const std::chrono::milliseconds ForALayer;
  mutable std::atomic<std::int64_t> Layers{0};
};

inline inr::BrickKey KeyAt(std::int64_t k) { return inr::KeyOf({0, {k, 0, 0}}); }

using StorePointer = std::unique_ptr<inr::BrickStore>;

inline StorePointer MakeKeyedStore(const std::shared_ptr<inr::CacheBudget>& budget, int brickSize,
                                   std::int64_t bytes, bool background = false)
{
  return std::make_unique<inr::BrickStore>(budget, std::make_shared<KeyedBricks>(brickSize),
                                           inr::CachePrecision::Float32, bytes, background, 1);
}

inline bool HasBrick(const inr::BrickStore& store, inr::BrickKey key)
{
  const std::int32_t slot = store.cache().find(key);
  return slot >= 0 &&
         static_cast<const float*>(store.cache().view(slot).voxels)[0] == KeyedBricks::ValueOf(key);
}

constexpr std::int64_t LeastBricks = inr::BrickCache::FewestBricks;
