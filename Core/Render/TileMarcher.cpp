// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/TileMarcher.h"

#include <algorithm>

namespace inr {

FrameStatistics TileMarcher::march(const Tile& tile, Image& rgba, Image* depth)
{
  this->Statistics = {};
  this->generateRays(tile);
  while (!this->Live.empty()) {
    this->placeSamples();
    this->inferValues();
    this->composite();
  }
  this->writePixels(tile, rgba, depth);
  return this->Statistics;
}

void TileMarcher::generateRays(const Tile& tile)
{
  const Frame& frame = this->Scene.frame;
  this->Rays.assign(static_cast<std::size_t>(tile.width) * tile.height, MarchState{});
  this->Live.clear();
  for (int k = 0; k < tile.width * tile.height; ++k) {
    const int x = tile.x + k % tile.width;
    const int y = tile.y + k / tile.width;
    MarchState& state = this->Rays[static_cast<std::size_t>(k)];
    state.ray = this->Scene.geometry.ray(x, y);
    state.jitter = JitterOf(PixelStream(frame, x, y));
    if (state.ray.length > 0) {
      this->Live.push_back(k);
    }
  }
  this->Statistics.rays = static_cast<std::int64_t>(this->Live.size());
}

void TileMarcher::placeSamples()
{
  this->Samples.clear();
  this->SampleEnds.clear();
  MarchSample placed[SamplesPerRound];
  for (const int k : this->Live) {
    const int count =
        PlaceSamples(this->Scene.majorants, this->Scene.settings,
                     this->Rays[static_cast<std::size_t>(k)], SamplesPerRound, placed);
    this->Samples.insert(this->Samples.end(), placed, placed + count);
    this->SampleEnds.push_back(static_cast<int>(this->Samples.size()));
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
}

void TileMarcher::composite()
{
  std::size_t alive = 0;
  std::size_t sample = 0;
  for (std::size_t live = 0; live < this->Live.size(); ++live) {
    MarchState& state = this->Rays[static_cast<std::size_t>(this->Live[live])];
    const auto end = static_cast<std::size_t>(this->SampleEnds[live]);
    const bool exhausted = end - sample < SamplesPerRound;
    for (; sample < end && state.color.w < OpaqueEnough; ++sample) {
      float value = this->Values[sample];
      this->Statistics.clamped += ClampToRange(this->Samples[sample].range, value) ? 1 : 0;
      Composite(this->Scene.colors.at(value), this->Samples[sample], state);
    }
    sample = end;
    if (!exhausted && state.color.w < OpaqueEnough) {
      this->Live[alive++] = this->Live[live];
    }
  }
  this->Live.resize(alive);
}

void TileMarcher::writePixels(const Tile& tile, Image& rgba, Image* depth) const
{
  for (int k = 0; k < tile.width * tile.height; ++k) {
    const int x = tile.x + k % tile.width;
    const int y = tile.y + k / tile.width;
    const MarchState& state = this->Rays[static_cast<std::size_t>(k)];
    std::copy_n(&state.color.x, 4, rgba.pixel(x, y));
    if (depth != nullptr) {
      const bool reached = state.halfOpaqueAt >= 0;
      const double z =
          reached ? this->Scene.geometry.windowDepth(state.ray.at(state.halfOpaqueAt)) : 1.0;
      *depth->pixel(x, y) = static_cast<float>(z);
    }
  }
}

} // namespace inr
