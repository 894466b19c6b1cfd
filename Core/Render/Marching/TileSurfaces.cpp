// SPDX-License-Identifier: BSD-3-Clause
//
// What TileMarcher does with a round's samples where it looks for isosurfaces.
#include "Core/Render/Marching/TileMarcher.h"

#include <algorithm>

namespace inr {

void TileMarcher::findSurfaces()
{
  this->inferBegins();
  this->listCrossings();
  this->bisectCrossings();
  this->placeOnSurfaces();
}

void TileMarcher::listCrossings()
{
  this->Crossings.clear();
  std::size_t k = 0;
  for (std::size_t live = 0; live < this->Live.size(); ++live) {
    for (; k < static_cast<std::size_t>(this->SampleEnds[live]); ++k) {
      this->listCrossing(static_cast<int>(live), this->Samples[k], this->Begins[k],
                         this->Values[k]);
    }
  }
}

void TileMarcher::listCrossing(int live, const MarchSample& sample, float first, float last)
{
  const SurfaceLookup& surfaces = this->Scene.settings.projector.surfaces;
  const int from = surfaces.below(first);
  const int to = surfaces.below(last);
  const Ray& ray =
      this->Rays[static_cast<std::size_t>(this->Live[static_cast<std::size_t>(live)])].ray;
  for (int surface = std::min(from, to); surface < std::max(from, to); ++surface) {
    this->Crossings.push_back(
        {{sample.begin, std::min(sample.end, ray.length), surfaces.values[surface], from < to},
         live});
  }
}

void TileMarcher::bisectCrossings()
{
  const auto count = static_cast<std::int64_t>(this->Crossings.size());
  this->Positions.resize(this->Crossings.size());
  std::vector<float> values(this->Crossings.size());
  for (int round = 0; round < SurfaceCrossing::Halvings; ++round) {
    std::transform(this->Crossings.begin(), this->Crossings.end(), this->Positions.begin(),
                   [this](const Crossing& crossing) {
                     const auto live = static_cast<std::size_t>(crossing.live);
                     const Ray& ray = this->Rays[static_cast<std::size_t>(this->Live[live])].ray;
                     return FieldPosition(this->Scene.settings, ray.at(crossing.middle()));
                   });
    this->Scene.evaluator.evaluate(this->Positions.data(), count, values.data());
    this->Statistics.samples += count;
    for (std::size_t k = 0; k < values.size(); ++k) {
      this->Crossings[k].halve(values[k]);
    }
  }
}

void TileMarcher::placeOnSurfaces()
{
  std::stable_sort(this->Crossings.begin(), this->Crossings.end(),
                   [](const Crossing& a, const Crossing& b) {
                     return a.live != b.live ? a.live < b.live : a.low < b.low;
                   });
  this->Samples.clear();
  this->Values.clear();
  std::fill(this->SampleEnds.begin(), this->SampleEnds.end(), 0);
  for (const Crossing& crossing : this->Crossings) {
    const auto live = static_cast<std::size_t>(crossing.live);
    const Ray& ray = this->Rays[static_cast<std::size_t>(this->Live[live])].ray;
    const double t = crossing.middle();
    if (!ray.isInPiece(t)) {
      continue; // another picture's
    }
    this->Samples.push_back({FieldPosition(this->Scene.settings, ray.at(t)),
                             {crossing.value, crossing.value},
                             1.0f, // opacity as it is
                             static_cast<float>(t),
                             t,
                             t});
    this->Values.push_back(crossing.value);
    this->SampleEnds[live] = static_cast<int>(this->Samples.size());
  }
  for (std::size_t live = 1; live < this->SampleEnds.size(); ++live) {
    this->SampleEnds[live] = std::max(this->SampleEnds[live], this->SampleEnds[live - 1]);
  }
}

} // namespace inr
