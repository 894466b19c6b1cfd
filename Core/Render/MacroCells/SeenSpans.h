// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MacroCells/MajorantView.h"
#include "Core/Render/MacroCells/SeenSpan.h"
#include "Core/Render/Rays/RayView.h"
#include "Core/Render/Tiles/Tiling.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// Between which depths, in each tile of a picture, macro-cells can be seen: rays go by those in
/// front of them and behind them without looking at any. The cells' boxes are drawn into a picture
/// of tiles. Pictures stay what they are: samples are in visible cells only.
class SeenSpans
{
public:
  /// Of cells whose extinctions are up to date. `dims`: voxels of the volume; `scale` and `levels`
  /// are LevelOfDetail's. Of a picture too small to be worth it, nothing is known.
  SeenSpans(const RayView& rays, const MajorantsView& majorants, const glm::dvec3& dims,
            double scale, int levels);

  /// Whether no ray through pixel (x, y) shows anything.
  bool isEmpty(int x, int y) const { return this->isKnown() && this->tileOf(x, y).empty(); }
  /// The same of all pixels of a tile.
  bool isEmpty(const Tile& tile) const;
  /// Of a ray through pixel (x, y), or of a part of it.
  SeenSpan of(const Ray& ray, int x, int y) const;

private:
  struct Depths
  {
    double low = Infinite;
    double high = -Infinite;

    bool empty() const { return this->low > this->high; }
    void extend(const Depths& other);
  };
  /// Pixels [first, last] along both axes.
  struct Pixels
  {
    glm::ivec2 first;
    glm::ivec2 last;
  };

  /// Draws all visible cells of a grid, unless these are too many.
  void draw(const MajorantGridView& cells);
  void draw(const Pixels& pixels, const Depths& depths);
  Pixels pixelsOf(const glm::dvec2& low, const glm::dvec2& high) const;
  void drawCell(const MajorantGridView& cells, const glm::i64vec3& cell);

  bool isKnown() const { return !this->Spans.empty(); }
  const Depths& tileOf(int x, int y) const
  {
    return this->Spans[static_cast<std::size_t>(y / Tiling::Edge) * this->Columns +
                       static_cast<std::size_t>(x / Tiling::Edge)];
  }

  glm::ivec2 Size; ///< of the picture
  std::size_t Columns;
  glm::dvec3 Dims;
  glm::dmat4 IndexToClip;
  glm::dvec4 Depth;          ///< of point indices: linear, and grows or falls along each ray
  Depths Anywhere;           ///< of cells that reach behind the camera
  std::vector<Depths> Spans; ///< of the tiles; none where nothing is known
};

} // namespace inr
