// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Render/MacroCells/Majorants.h"
#include "Core/Render/Marching/RayMarching.h"
#include "Core/Render/Marching/Shading.h"
#include "Core/Render/Marching/SurfaceCrossings.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/Tiling.h"

#include <functional>
#include <vector>

namespace inr {

class Arena;

/// What a frame's tiles share. All read-only.
struct MarchScene
{
  const Frame& frame;
  const RayGeometry& geometry;
  const Majorants& majorants;
  const ColorLookup& colors;
  const Evaluator& evaluator;
  MarchSettings settings;
  const Shading* shading; ///< null: colours as the transfer function gives them
};

/// Marches the rays of one tile together: place samples, infer them in one batch, composite, drop
/// the rays that are done. The queues are small enough to stay in the second-level cache.
class TileMarcher
{
public:
  explicit TileMarcher(const MarchScene& scene) : Scene(scene) {}

  /// Writes the tile's pixels; `depth` may be null.
  FrameStatistics march(const Tile& tile, Image& rgba, Image* depth);

private:
  struct Crossing : SurfaceCrossing ///< its places are t
  {
    int live; ///< which ray
  };

  void generateRays(const Tile& tile);
  void placeSamples();
  /// In their macro-cells' ranges; counts those that have to be moved.
  void inferValues();
  void listVisible();
  void inferGradients();
  void shade();
  /// Makes samples of the surfaces in a round's samples: the ones that are shaded and composited.
  void findSurfaces();
  /// Where both ends of samples are looked at: values before each of them.
  void inferBegins();
  /// What a sample shows per unit distance.
  glm::vec4 sampleColor(std::size_t sample) const;
  void listCrossings();
  void listCrossing(int ray, const MarchSample& sample, float first, float last);
  void bisectCrossings();
  void placeOnSurfaces();
  void composite();
  /// A round of samples, [first, end), of one ray; false when it needs no more.
  bool compositeRay(std::size_t first, std::size_t end, MarchState& state);
  bool projectRay(std::size_t first, std::size_t end, MarchState& state);
  /// Sends a ray that wants more on behind the next translucent layer; false when there is no more.
  bool enterNextPart(int k, bool goesOn);
  void writePixels(const Tile& tile, Image& rgba, Image* depth) const;

  const MarchScene& Scene;
  Tile Place{};
  FrameStatistics Statistics;
  std::vector<MarchState> Rays;
  std::vector<int> Live;
  std::vector<int> SampleEnds; ///< of each live ray, in Samples
  std::vector<MarchSample> Samples;
  std::vector<glm::vec3> Positions;
  std::vector<float> Values;
  std::vector<std::size_t> Visible; ///< samples that need a gradient
  std::vector<float> Neighbors;     ///< below and above each of them along x, y and z
  std::vector<glm::vec4> Lit;       ///< straight RGB and opacity of each sample
  std::vector<char> Exhausted;      ///< of each live ray: there are no more samples
  std::vector<float> Begins;        ///< where both ends are looked at, values before each sample
  std::vector<Crossing> Crossings;
};

/// Marches a whole picture. Throws Error(Cancelled) when `keepGoing` says so; see ForEachTile.
FrameStatistics MarchTiles(const MarchScene& scene, const Arena& arena, Image& rgba, Image* depth,
                           const std::function<bool()>& keepGoing);

} // namespace inr
