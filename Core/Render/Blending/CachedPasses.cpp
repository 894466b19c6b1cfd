// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/CachedPasses.h"

#include "Core/Render/Tiles/TileLoop.h"

#include <algorithm>

namespace inr {

std::int64_t CamePast(const FrameStatistics& statistics)
{
  return statistics.samples + statistics.hidden;
}

namespace {

double HalfOpaqueDepth(const CachedScene& scene, const CachedRay& ray)
{
  if (ray.layered.halfOpaqueDepth >= 0) {
    return ray.layered.halfOpaqueDepth;
  }
  return ray.halfOpaqueAt >= 0 ? scene.geometry.windowDepth(ray.ray.at(ray.halfOpaqueAt)) : 1.0;
}

void WritePixel(const CachedScene& scene, const CachedRay& ray, int x, int y,
                const PassOutput& output)
{
  float* pixel = output.rgba.pixel(x, y);
  const double* rgb = ray.color.rgb;
  const glm::vec3 seen =
      scene.frame.layers ? ray.layered.light.seen() : glm::vec3(rgb[0], rgb[1], rgb[2]);
  std::copy_n(&seen.x, 3, pixel);
  pixel[3] = static_cast<float>(1.0 - ray.color.transmittance);
  if (output.depth != nullptr) {
    *output.depth->pixel(x, y) = static_cast<float>(HalfOpaqueDepth(scene, ray));
  }
  if (output.samples != nullptr) {
    const auto count = static_cast<double>(ray.tally.samples);
    float* tally = output.samples->pixel(x, y);
    tally[0] = static_cast<float>(count);
    tally[1] = static_cast<float>(count > 0 ? ray.tally.levels / count : -1.0);
  }
}

/// Whether no ray of the tile has a sample: in large pictures of small things that is most of them,
/// and rays that come to nothing take as long to begin as others. Projections show what they find.
bool IsEmpty(const CachedScene& scene, const Tile& tile)
{
  return !scene.settings.projector.projects() && scene.seen->isEmpty(tile);
}

bool March(CachedMarcher& marcher, CachedRay& ray)
{
  const SampleTally before = marcher.tally();
  const bool done = marcher.march(ray);
  const SampleTally after = marcher.tally();
  ray.tally.samples += after.samples - before.samples;
  ray.tally.levels += after.levels - before.levels;
  return done;
}

} // namespace

void WriteEmpty(const Tile& tile, const PassOutput& output)
{
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    std::fill_n(output.rgba.pixel(tile.x, y), 4 * tile.width, 0.0f);
    if (output.depth != nullptr) {
      std::fill_n(output.depth->pixel(tile.x, y), tile.width, 1.0f);
    }
    for (int x = tile.x; output.samples != nullptr && x < tile.x + tile.width; ++x) {
      float* tally = output.samples->pixel(x, y);
      tally[0] = 0.0f;
      tally[1] = -1.0f;
    }
  }
}

void MarchTile(const CachedScene& scene, CachedMarcher& marcher, const Tile& tile,
               const std::function<bool()>& keepGoing, const PassOutput& output)
{
  if (IsEmpty(scene, tile)) {
    WriteEmpty(tile, output);
    return;
  }
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    RequireGoing(keepGoing);
    for (int x = tile.x; x < tile.x + tile.width; ++x) {
      CachedRay ray = marcher.begin(x, y);
      March(marcher, ray);
      WritePixel(scene, ray, x, y, output);
    }
  }
}

void CompletePass::start(ActiveTile& at, CachedMarcher& marcher, const PassOutput& output) const
{
  const Tile tile = this->Tiles.tile(at.tile);
  at.started = true;
  if (IsEmpty(this->Scene, tile)) {
    WriteEmpty(tile, output);
    return;
  }
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    for (int x = tile.x; x < tile.x + tile.width; ++x) {
      CachedRay ray = marcher.begin(x, y);
      if (March(marcher, ray)) {
        WritePixel(this->Scene, ray, x, y, output);
      } else {
        at.waiting.push_back({x, y, ray});
      }
    }
  }
}

void CompletePass::resume(ActiveTile& tile, CachedMarcher& marcher, const PassOutput& output) const
{
  bool first = true;
  const auto done = [&](WaitingRay& waiting) {
    const bool mayMarch = first || !this->Alone;
    first = false;
    if (!mayMarch || !March(marcher, waiting.ray)) {
      return false;
    }
    WritePixel(this->Scene, waiting.ray, waiting.x, waiting.y, output);
    return true;
  };
  const auto rest = std::remove_if(tile.waiting.begin(), tile.waiting.end(), done);
  tile.waiting.erase(rest, tile.waiting.end());
}

void CompletePass::marchTiles(const Arena& arena, const std::function<bool()>& keepGoing,
                              const PassOutput& output, std::vector<TileNotes>& notes)
{
  ForEachTile(arena, static_cast<std::int64_t>(notes.size()), keepGoing, [&](std::int64_t k) {
    const auto index = static_cast<std::size_t>(k);
    ActiveTile& tile = this->Active[index];
    CachedMarcher marcher(this->Scene, OnMiss::Stop);
    if (tile.started) {
      this->resume(tile, marcher, output);
    } else {
      this->start(tile, marcher, output);
    }
    notes[index] = {marcher.statistics(), std::move(marcher.requests())};
  });
}

WorkDone CompletePass::advance(const Arena& arena, const std::function<bool()>& keepGoing,
                               const PassOutput& output, RequestRanking& requests)
{
  while (this->Active.size() < this->Window && this->Next < this->Tiles.count()) {
    this->Active.push_back({this->Next++, false, {}});
  }
  const std::int64_t before = CamePast(this->Statistics);
  std::vector<TileNotes> notes(std::min(this->Active.size(), this->Alone ? 1 : this->Window));
  WorkDone work;
  const auto take = [&] {
    for (const TileNotes& tile : notes) {
      work.add(tile.statistics.work);
      this->Statistics.add(tile.statistics);
      requests.add(tile.requests);
    }
  };
  try {
    this->marchTiles(arena, keepGoing, output, notes);
  } catch (...) { // cancelled: tiles that have come further go on from there
    take();
    throw;
  }
  take();
  this->Alone = this->Alone && CamePast(this->Statistics) == before && !requests.empty();
  const auto finished = [](const ActiveTile& tile) { return tile.waiting.empty(); };
  this->Active.erase(std::remove_if(this->Active.begin(), this->Active.end(), finished),
                     this->Active.end());
  return work;
}

void CompletePass::crowd(std::int64_t loaded)
{
  this->Alone = loaded == 0;
  if (4 * loaded < this->Scene.bricks->cache().capacity()) {
    this->Window = std::max<std::size_t>(this->Window / 2, 1);
  }
}

} // namespace inr
