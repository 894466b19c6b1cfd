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

MarchWay Renderer::Implementation::wayOf(const Frame& frame)
{
  MarchWay way{RayGeometry(frame, this->Volume.dims), {}, ShadingOf(frame)};
  MarchSettings& settings = way.settings;
  settings.dims = glm::dvec3(this->Volume.dims);
  settings.step = frame.sampleDistance;
  settings.adaptive = frame.adaptiveSampling && frame.blending.mode == BlendMode::Composite;
  constexpr double opaque = 1e30; // so that float holds the lengths of the longest samples
  settings.unitsPerT = std::min(way.geometry.lengthPerUnit() / frame.unitDistance, opaque);
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
  return way;
}

FrameStatistics Renderer::Implementation::marchCached(const Frame& frame, MarchWay& way,
                                                      const WorkLimit& limit,
                                                      const PassOutput& output,
                                                      const std::function<bool()>& keepGoing)
{
  const BrickStore::Call call = this->Cached->call();
  const LevelChoice choice = this->chooseLevels(frame, limit, keepGoing, way.settings);
  FrameStatistics statistics =
      this->Cached->render(choice.frame, way.geometry, this->Cells, *this->Colors, way.settings,
                           way.lit(), limit, output, keepGoing);
  statistics.work.bricks = call.done();
  choice.addTo(statistics);
  return statistics;
}

FrameStatistics Renderer::Implementation::marchHere(const Frame& frame, MarchWay& way,
                                                    const Evaluator& field, const WorkLimit& limit,
                                                    const PassOutput& output,
                                                    const std::function<bool()>& keepGoing)
{
  if (this->Cached) {
    return this->marchCached(frame, way, limit, output, keepGoing);
  }
  const MarchScene scene{frame, way.geometry, this->Cells, this->Colors->lookup(),
                         field, way.settings, way.lit()};
  return MarchTiles(scene, this->Threads, output.rgba, output.depth, keepGoing);
}

std::optional<FrameStatistics>
Renderer::Implementation::marchElsewhere(const Frame& frame, MarchWay& way, const WorkLimit& limit,
                                         const PassOutput& output,
                                         const std::function<bool()>& keepGoing)
{
  const LevelChoice choice = this->chooseLevels(frame, limit, keepGoing, way.settings);
  std::optional<FrameStatistics> statistics = this->Drawn->march(
      {choice.frame, way.geometry, way.settings, this->Colors->lookup(), way.lit()}, limit, output,
      keepGoing);
  if (statistics) {
    choice.addTo(*statistics);
  }
  return statistics;
}

FrameStatistics Renderer::Implementation::march(const Frame& frame, const PassOutput& output,
                                                const std::function<bool()>& keepGoing)
{
  this->Paths.forget(frame.view);
  MarchWay way = this->wayOf(frame);
  const WorkLimit limit(frame.timeLimit, this->Options.deterministic);
  if (this->isDrawnElsewhere(frame, keepGoing)) {
    if (const std::optional<FrameStatistics> statistics =
            this->marchElsewhere(frame, way, limit, output, keepGoing)) {
      return *statistics;
    }
  }
  return this->marchHere(frame, way, *this->Samples, limit, output, keepGoing);
}

bool Renderer::Implementation::isDrawnElsewhere(const Frame& frame,
                                                const std::function<bool()>& keepGoing)
{
  if (!this->Drawn) {
    return false;
  }
  const auto elsewhere = [&](const Frame& small, const PassOutput& output) {
    this->proveElsewhere(small, output, keepGoing);
  };
  const auto here = [&](const Frame& small, const PassOutput& output) {
    this->proveHere(small, output, keepGoing);
  };
  // Where pictures make do with what fits, that is nowhere the same, but for the coarsest level.
  // And paths to lights go far at the level where they begin, through any number of bricks.
  const bool traces = frame.mode == RenderMode::PathTracing;
  const bool coarsest = this->Options.cache.onlyWhatFits || traces;
  if (traces) { // through the finer levels, rays go
    Frame rays = frame;
    rays.mode = RenderMode::RayMarching;
    this->Drawn->prove(rays, this->Options.cache.onlyWhatFits ? 1e9 : 1.0, elsewhere, here);
  }
  this->Drawn->prove(frame, coarsest ? 1e9 : 1.0, elsewhere, here);
  return this->Drawn->draws(frame);
}

void Renderer::Implementation::proveElsewhere(const Frame& small, const PassOutput& output,
                                              const std::function<bool()>& keepGoing)
{
  const WorkLimit none(0, this->Options.deterministic);
  if (small.mode == RenderMode::RayMarching) {
    MarchWay way = this->wayOf(small);
    this->marchElsewhere(small, way, none, output, keepGoing);
    return;
  }
  this->traceAlone(small, none, output, [&](const PathRound& round) {
    std::optional<TracedTiles> traced = this->Drawn->tracePaths(round, none, keepGoing);
    return traced ? std::move(*traced) : EmptyTiles(round); // it has failed: nobody looks at them
  });
}

void Renderer::Implementation::proveHere(const Frame& small, const PassOutput& output,
                                         const std::function<bool()>& keepGoing)
{
  const WorkLimit none(0, this->Options.deterministic);
  if (small.mode == RenderMode::RayMarching) {
    MarchWay way = this->wayOf(small);
    this->marchHere(small, way, *this->Field, none, output, keepGoing);
    return;
  }
  const TraceTiles trace = [&](const PathRound& round) {
    return this->traceHere(round, *this->Field, none, keepGoing);
  };
  if (this->Cached) {
    const BrickStore::Call call = this->Cached->call();
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

TracedTiles Renderer::Implementation::traceHere(const PathRound& round, const Evaluator& field,
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
  if (this->Drawn && this->Drawn->draws(round.tracer.frame())) {
    if (std::optional<TracedTiles> traced = this->Drawn->tracePaths(round, limit, keepGoing)) {
      return std::move(*traced);
    }
  }
  return this->traceHere(round, *this->Samples, limit, keepGoing);
}

FrameStatistics Renderer::Implementation::tracePaths(const Frame& frame, const PassOutput& output,
                                                     const std::function<bool()>& keepGoing)
{
  PathPicture& picture = this->Paths.of(frame.view);
  const WorkLimit limit(frame.timeLimit, this->Options.deterministic);
  if (!picture.continues(frame)) { // in its midst another would take the device's place
    this->isDrawnElsewhere(frame, keepGoing);
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
