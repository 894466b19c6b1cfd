// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/DeviceLayers.h"
#include "CUDA/Render/DevicePicture.h"
#include "CUDA/Render/DeviceScene.h"
#include "CUDA/Render/Kernels/PathKernels.h"
#include "CUDA/Render/PathTiles.h"
#include "CUDA/Render/WindowedRays.h"
#include "Core/Cache/CacheOptions.h"
#include "Core/Render/Acceleration/AcceleratedRenderer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/KeptFrame.h"
#include "Core/Render/Tiles/WorkLimit.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace inr {
namespace cuda {

/// Path-traced frames by a machine's kernels; see AcceleratedRenderer.
template <class Machine, class Cache> class DevicePaths
{
public:
  /// `most`: paths that wait at once.
  DevicePaths(Machine& machine, Cache& cache, const CacheOptions& options, std::int64_t most)
      : Where(machine), Bricks(cache), Options(options), Picture(machine),
        Scene(machine.template allocate<PathScene>(1)), Paths(machine, cache, most)
  {}

  TracedTiles trace(const PathRound& round, const DeviceColors<Machine>& colors,
                    const WorkLimit& limit, const std::function<bool()>& keepGoing)
  {
    const Timer timer;
    if (!this->Waiting || round.first || !this->Waiting->isOf(round)) {
      this->begin(round, colors);
    }
    this->Overfull = this->Overfull && !round.first;
    const bool waits =
        !this->Options.onlyWhatFits && (!limit.isLimited() || this->Overfull || this->Waiting);
    this->Picture.clearCounts();
    TracedTiles traced = waits ? this->traceFurther(round, limit, keepGoing)
                               : this->traceOnce(round, limit, keepGoing);
    traced.seconds = timer.seconds();
    return traced;
  }

  /// For when another kind of pictures is drawn.
  void clearLayers()
  {
    if (!this->Waiting) {
      this->Layers.clear();
    }
  }
  /// For when colours change.
  void forget()
  {
    this->Overfull = false;
    this->Waiting.reset();
  }

private:
  /// A round whose paths have not all come to their end, between the calls that it takes.
  struct Unfinished
  {
    explicit Unfinished(const PathRound& round) : frame(round.tracer.frame()), tiles(round.tiles) {}
    bool isOf(const PathRound& round) const
    {
      return this->frame.isOf(round.tracer.frame()) && round.tiles == this->tiles;
    }

    KeptFrame frame; ///< of the picture, with the number of its sample
    std::vector<std::int64_t> tiles;
    FrameStatistics soFar; ///< but for the work
  };

  /// Copies what the round needs.
  void begin(const PathRound& round, const DeviceColors<Machine>& colors)
  {
    this->Waiting.reset();
    const PathScene& given = round.tracer.scene();
    this->OfRound.clear();
    const LayersView layers = this->Layers.of(this->Where, round.tracer.frame());
    const PathScene scene = SceneOn(this->Where, given, colors, layers, this->OfRound);
    this->Where.toMachine(this->Scene.data(), &scene, 1);
    this->Picture.resize(std::int64_t{given.rays.width} * given.rays.height);
    const int view = round.tracer.frame().view;
    if (std::exchange(this->View, view) != view) { // of which paths that wait leave all as it was
      const Image* const depth = round.output.depth;
      this->Picture.copyFrom(round.output.rgba.pixels.data(),
                             depth != nullptr ? depth->pixels.data() : nullptr);
    }
    const std::vector<std::uint32_t> pixels = PixelsOf(round);
    const auto listed = static_cast<std::int64_t>(pixels.size());
    this->Order = {given.rays.width, given.rays.height,
                   this->OfRound.put(this->Where, pixels.data(), listed), listed};
    const std::int64_t tiles = Tiling(given.rays.width, given.rays.height).count();
    const std::vector<std::uint32_t> none(static_cast<std::size_t>(tiles), 0);
    this->TileMisses = this->OfRound.put(this->Where, none.data(), tiles);
  }

  TracePaths kernel(OnMiss onMiss) const
  {
    TracePaths kernel{};
    kernel.scene = this->Scene.data();
    kernel.onMiss = onMiss;
    kernel.picture = this->Picture.view();
    kernel.tileMisses = this->TileMisses;
    kernel.tileEdge = Tiling::Edge;
    kernel.counts = this->Picture.counts();
    return kernel;
  }

  /// To the end, or as far as there is time: the same tiles are asked for again then.
  TracedTiles traceFurther(const PathRound& round, const WorkLimit& limit,
                           const std::function<bool()>& keepGoing)
  {
    if (!this->Waiting) {
      this->Paths.begin(this->Order);
      this->Waiting.emplace(round);
    }
    // Counted, a round is one through all tiles.
    this->Paths.goOn(this->kernel(OnMiss::Stop), limit.isTimed() ? limit : WorkLimit(0, false),
                     this->Options.maximumRequests, keepGoing,
                     [&] { return this->Picture.statistics().samples > 0; });
    TracedTiles traced;
    traced.tiles = TilesToHost(round, this->Picture);
    const WorkDone work = traced.tiles.front().work;
    this->Waiting->soFar.add(traced.tiles.front());
    traced.tiles.front() = this->Waiting->soFar;
    traced.tiles.front().work = work;
    if (this->Paths.done()) {
      this->Waiting.reset();
    } else {
      for (FrameStatistics& tile : traced.tiles) {
        tile.missed = 1;
      }
    }
    return traced;
  }

  /// With what is there, and then some more comes in.
  TracedTiles traceOnce(const PathRound& round, const WorkLimit& limit,
                        const std::function<bool()>& keepGoing)
  {
    this->Bricks.beginFrame();
    this->Paths.runOnce(this->kernel(this->Options.preloading && limit.isLimited()
                                         ? OnMiss::Approach
                                         : OnMiss::UseCoarser),
                        this->Order, keepGoing);
    const std::int64_t most =
        limit.isLimited() ? this->Options.maximumRequests : this->Bricks.capacity();
    const bool full = this->Bricks.load(most, this->Options.ranking).isHopeless();
    this->Overfull = this->Overfull || full;
    TracedTiles traced;
    traced.final = full && this->Options.onlyWhatFits;
    traced.tiles = TilesToHost(round, this->Picture);
    const std::int64_t count = Tiling(this->Order.width, this->Order.height).count();
    std::vector<std::uint32_t> misses(static_cast<std::size_t>(count));
    this->Where.toHost(misses.data(), this->TileMisses, count);
    for (std::size_t k = 0; k < round.tiles.size(); ++k) {
      traced.tiles[k].missed = misses[static_cast<std::size_t>(round.tiles[k])];
    }
    return traced;
  }

  Machine& Where;
  Cache& Bricks;
  CacheOptions Options;
  DevicePicture<Machine> Picture;
  typename Machine::template Array<PathScene> Scene;
  WindowedRays<Machine, Cache, PathProgress> Paths;
  DeviceLayers<Machine> Layers;
  Belongings<Machine> OfRound;
  RayOrder Order{};                    ///< of the round
  std::uint32_t* TileMisses = nullptr; ///< of all tiles of the picture
  std::optional<Unfinished> Waiting;
  bool Overfull = false; ///< the latest picture wants more than the cache holds
  int View = 0;          ///< whose the pixels are
};

} // namespace cuda
} // namespace inr
