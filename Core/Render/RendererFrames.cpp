// SPDX-License-Identifier: BSD-3-Clause
//
// Who draws a renderer's frames: an accelerator or the CPU, through a cache or not.
#include "Core/Render/Marching/TileMarcher.h"
#include "Core/Render/Paths/CachedPaths.h"
#include "Core/Render/RendererImplementation.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace inr {

namespace {

/// Tiles of a round as if nothing had been missed in them.
TracedTiles EmptyTiles(const PathRound& round)
{
  TracedTiles traced;
  traced.tiles.resize(round.tiles.size());
  return traced;
}

} // namespace

MarchSetup Renderer::Implementation::setupFor(const Frame& frame)
{
  MarchSetup setup{RayGeometry(frame, this->Volume.dims), {}, ShadingOf(frame)};
  MarchSettings& settings = setup.settings;
  settings.dims = glm::dvec3(this->Volume.dims);
  settings.step = frame.sampleDistance;
  settings.adaptive = frame.adaptiveSampling && frame.blending.mode == BlendMode::Composite;
  constexpr double opaque = 1e30; // so that float holds the lengths of the longest samples
  settings.unitsPerT = std::min(setup.geometry.lengthPerUnit() / frame.unitDistance, opaque);
  settings.projector = this->projector();
  if (frame.preIntegration) {
    if (!this->PreIntegrated) {
      this->PreIntegrated.emplace(this->Colors->lookup());
    }
    settings.preIntegrated = &this->PreIntegrated->lookup();
  }
  if (frame.cropping && !BoxOf(*frame.cropping).full) { // rays end where a box does
    settings.crops = true;
    settings.cropping = *frame.cropping;
  }
  return setup;
}

FrameStatistics Renderer::Implementation::marchCached(const Frame& frame, MarchSetup& setup,
                                                      const DrawCall& call)
{
  const BrickStore::Call turn = this->Cached->call();
  const LevelChoice choice = this->chooseLevels(frame, call, setup.settings);
  FrameStatistics statistics = this->Cached->render(setup.job(choice.frame, this->Colors->lookup()),
                                                    this->Cells, *this->Colors, call);
  statistics.work.bricks = turn.done();
  choice.addTo(statistics);
  return statistics;
}

FrameStatistics Renderer::Implementation::marchOnCpu(const Frame& frame, MarchSetup& setup,
                                                     const Evaluator& field, const DrawCall& call)
{
  if (this->Cached) {
    return this->marchCached(frame, setup, call);
  }
  const MarchScene scene{frame, setup.geometry, this->Cells, this->Colors->lookup(),
                         field, setup.settings, setup.lit()};
  return MarchTiles(scene, this->Threads, call.output.rgba, call.output.depth, call.keepGoing);
}

std::optional<FrameStatistics>
Renderer::Implementation::marchOnDevice(const Frame& frame, MarchSetup& setup, const DrawCall& call)
{
  const LevelChoice choice = this->chooseLevels(frame, call, setup.settings);
  std::optional<FrameStatistics> statistics =
      this->Drawn->march(setup.job(choice.frame, this->Colors->lookup()), call);
  if (statistics) {
    choice.addTo(*statistics);
  }
  return statistics;
}

FrameStatistics Renderer::Implementation::march(const Frame& frame, const PassOutput& output,
                                                const std::function<bool()>& keepGoing)
{
  this->Paths.forget(frame.view);
  MarchSetup setup = this->setupFor(frame);
  const WorkLimit limit(frame.timeLimit, this->Options.deterministic, frame.sharedBy);
  const DrawCall call{output, limit, keepGoing};
  this->proveDevice(frame, keepGoing);
  if (this->isForDevice(frame)) {
    if (const auto statistics = this->marchOnDevice(frame, setup, call)) {
      return *statistics;
    }
  }
  return this->marchOnCpu(frame, setup, *this->Samples, call);
}

void Renderer::Implementation::proveDevice(const Frame& frame,
                                           const std::function<bool()>& keepGoing)
{
  if (!this->Drawn) {
    return;
  }
  const auto device = [&](const Frame& small, const PassOutput& output) {
    this->proveOnDevice(small, output, keepGoing);
  };
  const auto cpu = [&](const Frame& small, const PassOutput& output) {
    this->proveOnCpu(small, output, keepGoing);
  };
  // Where pictures make do with what fits, that is nowhere the same, but for the coarsest level.
  // And paths to lights go far at the level where they begin, through any number of bricks.
  const bool traces = frame.mode == RenderMode::PathTracing;
  const bool coarsest = this->Options.cache.onlyWhatFits || traces;
  if (traces) { // through the finer levels, rays go
    Frame rays = frame;
    rays.mode = RenderMode::RayMarching;
    this->Drawn->prove(rays, this->Options.cache.onlyWhatFits ? 1e9 : 1.0, device, cpu);
  }
  this->Drawn->prove(frame, coarsest ? 1e9 : 1.0, device, cpu);
}

void Renderer::Implementation::proveOnDevice(const Frame& small, const PassOutput& output,
                                             const std::function<bool()>& keepGoing)
{
  const WorkLimit none(0, this->Options.deterministic);
  if (small.mode == RenderMode::RayMarching) {
    MarchSetup setup = this->setupFor(small);
    this->marchOnDevice(small, setup, {output, none, keepGoing});
    return;
  }
  this->traceAlone(small, none, output, [&](const PathRound& round) {
    std::optional<TracedTiles> traced = this->Drawn->tracePaths(round, none, keepGoing);
    return traced ? std::move(*traced) : EmptyTiles(round); // it has failed: nobody looks at them
  });
}

void Renderer::Implementation::proveOnCpu(const Frame& small, const PassOutput& output,
                                          const std::function<bool()>& keepGoing)
{
  const WorkLimit none(0, this->Options.deterministic);
  if (small.mode == RenderMode::RayMarching) {
    MarchSetup setup = this->setupFor(small);
    this->marchOnCpu(small, setup, *this->Field, {output, none, keepGoing});
    return;
  }
  const TraceTiles trace = [&](const PathRound& round) {
    return this->traceOnCpu(round, *this->Field, none, keepGoing);
  };
  if (this->Cached) {
    const BrickStore::Call turn = this->Cached->call();
    this->traceAlone(small, none, output, trace);
  } else {
    this->traceAlone(small, none, output, trace);
  }
}

PathMedium Renderer::Implementation::medium() const
{
  const int levels = this->Cached ? this->Cached->store().cache().hierarchy().levels() : 1;
  return {this->Volume.dims, this->Cells, this->Colors->lookup(), levels};
}

void Renderer::Implementation::traceAlone(const Frame& frame, const WorkLimit& limit,
                                          const PassOutput& output, const TraceTiles& trace)
{
  PathPicture picture;
  picture.advance(frame, this->medium(), trace, limit, output);
}

TracedTiles Renderer::Implementation::traceOnCpu(const PathRound& round, const Evaluator& field,
                                                 const WorkLimit& limit,
                                                 const std::function<bool()>& keepGoing)
{
  return this->Cached
             ? this->Cached->tracePaths(round, this->Cells, *this->Colors, limit, keepGoing)
             : TraceWithNetwork(round, field, this->Volume.dims, this->Threads, keepGoing);
}

TracedTiles Renderer::Implementation::traceRound(const PathRound& round, const WorkLimit& limit,
                                                 const std::function<bool()>& keepGoing)
{
  if (this->isForDevice(round.tracer.frame())) {
    if (std::optional<TracedTiles> traced = this->Drawn->tracePaths(round, limit, keepGoing)) {
      return std::move(*traced);
    }
  }
  return this->traceOnCpu(round, *this->Samples, limit, keepGoing);
}

FrameStatistics Renderer::Implementation::tracePaths(const Frame& frame, const PassOutput& output,
                                                     const std::function<bool()>& keepGoing)
{
  PathPicture& picture = this->Paths.of(frame.view);
  const WorkLimit limit(frame.timeLimit, this->Options.deterministic, frame.sharedBy);
  if (!picture.continues(frame)) { // in its midst another would take the device's place
    this->proveDevice(frame, keepGoing);
  }
  const TraceTiles trace = [&](const PathRound& round) {
    return this->traceRound(round, limit, keepGoing);
  };
  if (!this->Cached) {
    return picture.advance(frame, this->medium(), trace, limit, output);
  }
  const BrickStore::Call call = this->Cached->call();
  FrameStatistics statistics = picture.advance(frame, this->medium(), trace, limit, output);
  statistics.work.bricks = call.done();
  return statistics;
}

} // namespace inr
