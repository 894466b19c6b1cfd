// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/DeviceMarcher.h"
#include "CUDA/Render/DevicePaths.h"
#include "CUDA/Render/DeviceStore.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace inr {
namespace cuda {

/// How many rays of a picture wait at once: for each the machine has memory.
struct WindowSizes
{
  std::int64_t rays = 1 << 20;  ///< 160 MiB of their progress, 240 at most
  std::int64_t paths = 1 << 17; ///< 69 MiB
};

/// Draws frames through a cache by kernels on a machine; see AcceleratedRenderer.
template <class Machine, class Cache> class DeviceRenderer : public AcceleratedRenderer
{
public:
  using Store = DeviceStore<Machine, Cache>;

  DeviceRenderer(std::shared_ptr<Store> store, const CacheOptions& options,
                 const WindowSizes& sizes = {})
      : Shared(std::move(store)), Marcher(this->Shared->machine, this->Shared->beside,
                                          this->Shared->cache, options, sizes.rays),
        Paths(this->Shared->machine, this->Shared->cache, options, sizes.paths)
  {}

  bool draws(const Frame& frame) const override { return TakesLayersOf(frame); }

  void setColors(const Majorants& majorants, const ColorLookup& colors) override
  {
    const typename Store::Turn turn(*this->Shared);
    this->Marcher.forget();
    this->Paths.forget();
    this->Colors.set(this->Shared->machine, majorants, colors);
  }

  FrameStatistics march(const MarchJob& job, const DrawCall& call) override
  {
    const typename Store::Turn turn(*this->Shared);
    this->Paths.clearLayers();
    return this->Marcher.march(job, this->Colors, call);
  }

  TracedTiles tracePaths(const PathRound& round, const WorkLimit& limit,
                         const std::function<bool()>& keepGoing) override
  {
    const typename Store::Turn turn(*this->Shared);
    this->Marcher.clearLayers();
    return this->Paths.trace(round, this->Colors, limit, keepGoing);
  }

  std::int64_t bytes() const override { return this->Shared->bytes(); }
  std::int64_t bricks() const override { return this->Shared->cache.mapped(); }

private:
  std::shared_ptr<Store> Shared;
  DeviceColors<Machine> Colors;
  DeviceMarcher<Machine, Cache> Marcher;
  DevicePaths<Machine, Cache> Paths;
};

} // namespace cuda
} // namespace inr
