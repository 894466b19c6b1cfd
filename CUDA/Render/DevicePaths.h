// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/DevicePicture.h"
#include "CUDA/Render/DeviceScene.h"
#include "CUDA/Render/Kernels/PathKernels.h"
#include "CUDA/Render/PathTiles.h"
#include "CUDA/Render/WindowedRays.h"
#include "Core/Render/AcceleratedRenderer.h"
#include "Core/Render/CachedRenderer.h"
#include "Core/Render/WorkLimit.h"

#include <vector>

namespace inr {
namespace cuda {

/// Path-traced frames by a machine's kernels; see AcceleratedRenderer.
template <class Machine, class Cache> class DevicePaths
{
public:
  DevicePaths(Machine& machine, Cache& cache, const CacheOptions& options)
      : Where(machine), Bricks(cache), Options(options), Picture(machine),
        Scene(machine.template allocate<PathScene>(1)), Paths(machine, cache, MostPaths)
  {}

  TracedTiles trace(const PathRound& round, const DeviceColors<Machine>& colors,
                    const WorkLimit& limit, const std::function<bool()>& keepGoing)
  {
    const PathScene& given = round.tracer.scene();
    Belongings<Machine>& arrays = this->OfRound;
    arrays.clear();
    const PathScene scene = SceneOn(this->Where, given, colors, arrays);
    this->Where.toMachine(this->Scene.data(), &scene, 1);
    const int width = given.rays.width;
    const int height = given.rays.height;
    const Tiling tiling(width, height);
    this->Picture.resize(std::int64_t{width} * height);
    this->Picture.clearCounts();
    const std::vector<std::uint32_t> pixels = PixelsOf(round);
    const RayOrder order{
        width, height,
        arrays.put(this->Where, pixels.data(), static_cast<std::int64_t>(pixels.size())),
        static_cast<std::int64_t>(pixels.size())};
    std::vector<std::uint32_t> misses(static_cast<std::size_t>(tiling.count()), 0);
    TracePaths kernel = this->kernel();
    kernel.tileMisses = arrays.put(this->Where, misses.data(), tiling.count());
    this->Overfull = this->Overfull && !round.first;
    const bool waits = !this->Options.onlyWhatFits && (!limit.isLimited() || this->Overfull);
    const Timer timer;
    TracedTiles traced =
        waits ? this->traceToEnd(kernel, order, keepGoing) : this->traceOnce(kernel, order, limit);
    traced.seconds = timer.seconds();
    this->Where.toHost(misses.data(), kernel.tileMisses, tiling.count());
    traced.tiles = TilesToHost(round, this->Picture);
    for (std::size_t k = 0; k < round.tiles.size(); ++k) {
      traced.tiles[k].missed = misses[static_cast<std::size_t>(round.tiles[k])];
    }
    return traced;
  }

  /// For when colours change.
  void forget() { this->Overfull = false; }

private:
  static constexpr std::int64_t MostPaths = 1 << 17; ///< 72 MB of their progress

  TracePaths kernel() const
  {
    TracePaths kernel{};
    kernel.scene = this->Scene.data();
    kernel.picture = this->Picture.view();
    kernel.tileEdge = Tiling::Edge;
    kernel.counts = this->Picture.counts();
    return kernel;
  }

  TracedTiles traceToEnd(TracePaths kernel, const RayOrder& order,
                         const std::function<bool()>& keepGoing)
  {
    kernel.onMiss = OnMiss::Stop;
    this->Paths.runToEnd(kernel, order, keepGoing);
    return {};
  }

  /// With what is there, and then some more comes in.
  TracedTiles traceOnce(TracePaths kernel, const RayOrder& order, const WorkLimit& limit)
  {
    kernel.onMiss =
        this->Options.preloading && limit.isLimited() ? OnMiss::Approach : OnMiss::UseCoarser;
    this->Bricks.beginFrame();
    this->Paths.runOnce(kernel, order);
    const std::int64_t most =
        limit.isLimited() ? this->Options.maximumRequests : this->Bricks.capacity();
    const bool full = this->Bricks.load(most, this->Options.ranking).isHopeless();
    this->Overfull = this->Overfull || full;
    TracedTiles traced;
    traced.final = full && this->Options.onlyWhatFits;
    return traced;
  }

  Machine& Where;
  Cache& Bricks;
  CacheOptions Options;
  DevicePicture<Machine> Picture;
  typename Machine::template Array<PathScene> Scene;
  WindowedRays<Machine, Cache, PathProgress> Paths;
  Belongings<Machine> OfRound;
  bool Overfull = false; ///< the present picture wants more than the cache holds
};

} // namespace cuda
} // namespace inr
