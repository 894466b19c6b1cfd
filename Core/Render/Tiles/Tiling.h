// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace inr {

/// A screen tile: pixels [x, x + width) x [y, y + height).
struct Tile
{
  int x, y, width, height;
};

/// Row-major tiles of a picture; those at the right and upper rim may be smaller.
class Tiling
{
public:
  static constexpr int Edge = 16; ///< of what stays in a core's caches

  /// `edge`: pixels, at least 1.
  Tiling(int width, int height, int edge = Edge) : Width(width), Height(height), Size(edge) {}

  int columns() const { return (this->Width + this->Size - 1) / this->Size; }
  int rows() const { return (this->Height + this->Size - 1) / this->Size; }
  std::int64_t count() const { return static_cast<std::int64_t>(this->columns()) * this->rows(); }
  Tile tile(std::int64_t k) const
  {
    const int x = static_cast<int>(k % this->columns()) * this->Size;
    const int y = static_cast<int>(k / this->columns()) * this->Size;
    return {x, y, std::min(this->Size, this->Width - x), std::min(this->Size, this->Height - y)};
  }

private:
  int Width;
  int Height;
  int Size;
};

/// Edge of the largest tiles, the usual one times a power of two, whose pixels ask for no more than
/// `points` points at once, so many each.
inline int EdgeFor(std::int64_t points, int pointsPerPixel)
{
  int edge = Tiling::Edge;
  while (std::int64_t{4} * edge * edge * pointsPerPixel <= points) {
    edge *= 2;
  }
  return edge;
}

} // namespace inr
