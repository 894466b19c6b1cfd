// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Marching/TileMarcher.h"

#include "Core/Render/Tiles/TileLoop.h"
#include "Core/Timer.h"

#include <algorithm>

namespace inr {

FrameStatistics TileMarcher::march(const Tile& tile, Image& rgba, Image* depth)
{
  this->Statistics = {};
  this->generateRays(tile);
  while (!this->Live.empty()) {
    this->placeSamples();
    this->inferValues();
    if (this->Scene.settings.projector.findsSurfaces()) {
      this->findSurfaces();
    } else if (this->Scene.settings.preIntegrated != nullptr) {
      this->inferBegins();
    }
    if (this->Scene.shading != nullptr) {
      this->inferGradients();
      this->shade();
    }
    this->composite();
  }
  this->writePixels(tile, rgba, depth);
  for (const MarchState& state : this->Rays) {
    this->Statistics.work.cells += state.samples.visited();
  }
  this->Statistics.work.networkSamples = this->Statistics.samples;
  return this->Statistics;
}

void TileMarcher::generateRays(const Tile& tile)
{
  const Frame& frame = this->Scene.frame;
  this->Place = tile;
  this->Rays.clear();
  this->Live.clear();
  for (int k = 0; k < tile.width * tile.height; ++k) {
    const int x = tile.x + k % tile.width;
    const int y = tile.y + k / tile.width;
    const Ray ray = this->Scene.geometry.ray(x, y, 0);
    const double jitter = JitterOf(this->Scene.settings, StreamsOf(frame).at(x, y));
    const SampleWalker samples(this->Scene.majorants.view(), this->Scene.settings, ray, 0, 1,
                               jitter);
    this->Rays.push_back({ray, samples});
    if (ray.length > 0 || (frame.layers && this->Scene.geometry.ray(x, y).length > 0)) {
      this->Live.push_back(k);
    }
  }
  this->Statistics.rays = static_cast<std::int64_t>(this->Live.size());
}

void TileMarcher::placeSamples()
{
  this->Samples.clear();
  this->SampleEnds.clear();
  this->Exhausted.clear();
  MarchSample placed[SamplesPerRound];
  for (const int k : this->Live) {
    const int count = PlaceSamples(this->Scene.settings, this->Rays[static_cast<std::size_t>(k)],
                                   SamplesPerRound, placed);
    this->Samples.insert(this->Samples.end(), placed, placed + count);
    this->SampleEnds.push_back(static_cast<int>(this->Samples.size()));
    this->Exhausted.push_back(count < SamplesPerRound ? 1 : 0);
  }
}

void TileMarcher::inferValues()
{
  this->Positions.resize(this->Samples.size());
  this->Values.resize(this->Samples.size());
  std::transform(this->Samples.begin(), this->Samples.end(), this->Positions.begin(),
                 [](const MarchSample& sample) { return sample.position; });
  const auto count = static_cast<std::int64_t>(this->Samples.size());
  this->Scene.evaluator.evaluate(this->Positions.data(), count, this->Values.data());
  this->Statistics.samples += count;
  for (std::size_t k = 0; k < this->Samples.size(); ++k) {
    this->Statistics.clamped += ClampToRange(this->Samples[k].range, this->Values[k]) ? 1 : 0;
  }
}

void TileMarcher::composite()
{
  const bool projects = this->Scene.settings.projector.projects();
  std::size_t alive = 0;
  std::size_t sample = 0;
  for (std::size_t live = 0; live < this->Live.size(); ++live) {
    MarchState& state = this->Rays[static_cast<std::size_t>(this->Live[live])];
    const auto end = static_cast<std::size_t>(this->SampleEnds[live]);
    const bool goesOn =
        projects ? this->projectRay(sample, end, state) : this->compositeRay(sample, end, state);
    sample = end;
    if (this->Exhausted[live] != 0 ? this->enterNextPart(this->Live[live], goesOn) : goesOn) {
      this->Live[alive++] = this->Live[live];
    }
  }
  this->Live.resize(alive);
}

bool TileMarcher::compositeRay(std::size_t first, std::size_t end, MarchState& state)
{
  for (std::size_t k = first; k < end && state.color.w < OpaqueEnough; ++k) {
    const glm::vec4 color = this->Scene.shading != nullptr ? this->Lit[k] : this->sampleColor(k);
    Composite(color, this->Samples[k], state);
  }
  return state.color.w < OpaqueEnough;
}

bool TileMarcher::projectRay(std::size_t first, std::size_t end, MarchState& state)
{
  const Projector& projector = this->Scene.settings.projector;
  for (std::size_t k = first; k < end; ++k) {
    const MarchSample& sample = this->Samples[k];
    projector.add(this->Scene.colors, this->Values[k], static_cast<double>(sample.length),
                  static_cast<double>(sample.t), state.projection);
  }
  return !projector.isFinal(state.projection);
}

bool TileMarcher::enterNextPart(int k, bool goesOn)
{
  const Frame& frame = this->Scene.frame;
  if (!goesOn || !frame.layers) {
    return false;
  }
  MarchState& state = this->Rays[static_cast<std::size_t>(k)];
  const int x = this->Place.x + k % this->Place.width;
  const int y = this->Place.y + k / this->Place.width;
  const RayView& rays = this->Scene.geometry.view();
  if (!EnterNextPart(rays, x, y, state)) {
    return false;
  }
  this->Statistics.work.cells += state.samples.visited();
  state.samples = SampleWalker(this->Scene.majorants.view(), this->Scene.settings, state.ray, 0, 1,
                               JitterOf(this->Scene.settings, StreamsOf(frame).at(x, y)));
  return true;
}

void TileMarcher::writePixels(const Tile& tile, Image& rgba, Image* depth) const
{
  for (int k = 0; k < tile.width * tile.height; ++k) {
    const int x = tile.x + k % tile.width;
    const int y = tile.y + k / tile.width;
    const MarchState& state = this->Rays[static_cast<std::size_t>(k)];
    const Projector& projector = this->Scene.settings.projector;
    const RayView& rays = this->Scene.geometry.view();
    const glm::vec4 color = ShownColor(state, projector, this->Scene.colors, rays);
    std::copy_n(&color.x, 4, rgba.pixel(x, y));
    if (depth != nullptr) {
      *depth->pixel(x, y) =
          static_cast<float>(ShownDepth(state, projector, this->Scene.colors, rays));
    }
  }
}

FrameStatistics MarchTiles(const MarchScene& scene, const Arena& arena, Image& rgba, Image* depth,
                           const std::function<bool()>& keepGoing)
{
  const Timer timer;
  const int edge = EdgeFor(scene.evaluator.pointsAtOnce(), SamplesPerRound);
  const Tiling tiling(scene.frame.width, scene.frame.height, edge);
  std::vector<FrameStatistics> tiles(static_cast<std::size_t>(tiling.count()));
  ForEachTile(arena, tiling.count(), keepGoing, [&](std::int64_t k) {
    TileMarcher marcher(scene);
    tiles[static_cast<std::size_t>(k)] = marcher.march(tiling.tile(k), rgba, depth);
  });
  FrameStatistics statistics;
  for (const FrameStatistics& tile : tiles) {
    statistics.add(tile);
  }
  statistics.marchSeconds = timer.seconds();
  return statistics;
}

} // namespace inr
