// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MacroCells/SeenSpans.h"

#include "Core/Render/Rays/LevelOfDetail.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// A cell takes about a tenth of a microsecond to draw, a pixel that shows something one or two.
constexpr std::int64_t PixelsPerCell = 32;
/// Of grids of more cells than so many times what may be drawn, not even these are looked at.
constexpr std::int64_t CellsPerVisible = 8;

/// Distance from the camera, but for a factor; of parallel rays, from the near plane.
glm::dvec4 DepthOf(const glm::dmat4& indexToClip, const glm::dvec3& dims)
{
  const glm::dvec4 w = glm::row(indexToClip, 3);
  const bool isParallel = glm::length(glm::dvec3(w) * dims) <= 1e-9 * std::abs(w.w);
  return isParallel ? glm::row(indexToClip, 2) : w;
}

/// Footprint that a ray has at most inside the volume. A step to the next pixel is one of
/// the same clip-space x, times w, everywhere; of projections of which that is not so, infinite.
double LargestFootprint(const RayView& rays, const glm::dmat4& indexToClip)
{
  constexpr double rounding = 1e-6;
  const glm::dmat4& toWorld = rays.clipToWorld;
  const double smallest = std::min(std::abs(toWorld[3].w - toWorld[2].w),  // at the near plane,
                                   std::abs(toWorld[3].w + toWorld[2].w)); // and at the far one
  if (!(std::max(std::abs(toWorld[0].w), std::abs(toWorld[1].w)) <= rounding * smallest)) {
    return Infinite;
  }
  double largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 high(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec4 index(glm::mix(rays.low, rays.high, high), 1.0);
    largest = std::max(largest, std::abs(glm::dot(glm::row(indexToClip, 3), index)));
  }
  const double pixel = glm::length(glm::dvec3(toWorld[0])) * 2.0 / rays.width;
  return (1.0 + 10 * rounding) * largest * pixel / rays.voxel.least();
}

/// Footprint up to which LevelOfDetail chooses levels that a grid bounds.
double LargestFootprintFor(int coarsestLevel, int levels)
{
  return coarsestLevel >= levels - 1 ? Infinite
                                     : LevelOfDetail::MixedFrom * std::ldexp(1.0, coarsestLevel);
}

std::int64_t CountVisible(const MajorantGridView& cells)
{
  return cells.count() - std::count(cells.extinctions(), cells.extinctions() + cells.count(), 0.0f);
}

} // namespace

SeenSpans::SeenSpans(const RayView& rays, const MajorantsView& majorants, const glm::dvec3& dims,
                     double scale, int levels)
    : Size(rays.width, rays.height),
      Columns(static_cast<std::size_t>(Tiling(rays.width, rays.height).columns())), Dims(dims),
      IndexToClip(rays.indexToClip), Depth(DepthOf(this->IndexToClip, dims))
{
  const double footprint = scale > 0 ? scale * LargestFootprint(rays, this->IndexToClip) : 0.0;
  for (int grid = 0; grid < majorants.grids() && !this->isKnown(); ++grid) {
    if (footprint <= LargestFootprintFor(majorants.coarsestLevel(grid), levels)) {
      this->draw(majorants.grid(grid));
    }
  }
}

void SeenSpans::draw(const MajorantGridView& cells)
{
  const std::int64_t most = std::int64_t{this->Size.x} * this->Size.y / PixelsPerCell;
  if (cells.count() > CellsPerVisible * most || CountVisible(cells) > most) {
    return;
  }
  this->Spans.resize(static_cast<std::size_t>(Tiling(this->Size.x, this->Size.y).count()));
  const glm::i64vec3& dims = cells.dims();
  for (std::int64_t z = 0; z < dims.z; ++z) {
    for (std::int64_t y = 0; y < dims.y; ++y) {
      for (std::int64_t x = 0; x < dims.x; ++x) {
        if (cells.extinction(cells.index({x, y, z})) > 0.0f) {
          this->drawCell(cells, {x, y, z});
        }
      }
    }
  }
  this->draw({glm::ivec2(0), this->Size - 1}, this->Anywhere); // all at once: there may be many
}

void SeenSpans::drawCell(const MajorantGridView& cells, const glm::i64vec3& cell)
{
  const glm::dvec3 edge = cells.spacing() * this->Dims;
  Depths depths;
  glm::dvec2 low(Infinite);
  glm::dvec2 high(-Infinite);
  bool isInFront = true;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 place =
        glm::dvec3(cell) + glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec4 index(glm::min(place * edge, this->Dims) - 0.5, 1.0);
    const glm::dvec4 clip = this->IndexToClip * index;
    const double depth = glm::dot(this->Depth, index);
    depths.extend({depth, depth});
    isInFront = isInFront && clip.w > 0;
    low = glm::min(low, glm::dvec2(clip) / clip.w);
    high = glm::max(high, glm::dvec2(clip) / clip.w);
  }
  if (isInFront) {
    this->draw(this->pixelsOf(low, high), depths);
  } else {
    this->Anywhere.extend(depths);
  }
}

SeenSpans::Pixels SeenSpans::pixelsOf(const glm::dvec2& low, const glm::dvec2& high) const
{
  const glm::dvec2 size(this->Size);
  const glm::dvec2 begin = (low + 1.0) * 0.5 * size - 1.5; // a pixel more, for rounding
  const glm::dvec2 end = (high + 1.0) * 0.5 * size + 0.5;
  return {glm::ivec2(glm::clamp(glm::floor(begin), glm::dvec2(0.0), size)),
          glm::ivec2(glm::clamp(glm::ceil(end), glm::dvec2(-1.0), size - 1.0))};
}

void SeenSpans::draw(const Pixels& pixels, const Depths& depths)
{
  if (pixels.first.x > pixels.last.x || pixels.first.y > pixels.last.y) {
    return; // beside the picture
  }
  const glm::ivec2 first = pixels.first / Tiling::Edge;
  const glm::ivec2 last = pixels.last / Tiling::Edge;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      this->Spans[static_cast<std::size_t>(y) * this->Columns + static_cast<std::size_t>(x)].extend(
          depths);
    }
  }
}

void SeenSpans::Depths::extend(const Depths& other)
{
  this->low = std::min(this->low, other.low);
  this->high = std::max(this->high, other.high);
}

bool SeenSpans::isEmpty(const Tile& tile) const
{
  for (int y = tile.y; y < tile.y + tile.height; y = (y / Tiling::Edge + 1) * Tiling::Edge) {
    for (int x = tile.x; x < tile.x + tile.width; x = (x / Tiling::Edge + 1) * Tiling::Edge) {
      if (!this->isEmpty(x, y)) {
        return false;
      }
    }
  }
  return true;
}

SeenSpan SeenSpans::of(const Ray& ray, int x, int y) const
{
  if (!this->isKnown()) {
    return {};
  }
  constexpr SeenSpan nothing{Infinite, -Infinite};
  const Depths& depths = this->tileOf(x, y);
  if (depths.empty()) {
    return nothing;
  }
  const double perDepth = 1.0 / glm::dot(glm::dvec3(this->Depth), ray.direction);
  const double atEntry = glm::dot(this->Depth, glm::dvec4(ray.entry, 1.0));
  const double a = (depths.low - atEntry) * perDepth;
  const double b = (depths.high - atEntry) * perDepth;
  if (!std::isfinite(a) || !std::isfinite(b)) { // a line on which all depths are the same
    return {};
  }
  const double rounding = 1e-6 * (1.0 + ray.length);
  const SeenSpan span{std::min(a, b) - rounding, std::max(a, b) + rounding};
  return span.begin > ray.length || span.end < 0 ? nothing : span;
}

} // namespace inr
