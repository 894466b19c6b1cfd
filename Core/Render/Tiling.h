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
  static constexpr int Edge = 16;

  Tiling(int width, int height) : Width(width), Height(height) {}

  int columns() const { return (this->Width + Edge - 1) / Edge; }
  int rows() const { return (this->Height + Edge - 1) / Edge; }
  std::int64_t count() const { return static_cast<std::int64_t>(this->columns()) * this->rows(); }
  Tile tile(std::int64_t k) const
  {
    const int x = static_cast<int>(k % this->columns()) * Edge;
    const int y = static_cast<int>(k / this->columns()) * Edge;
    return {x, y, std::min(Edge, this->Width - x), std::min(Edge, this->Height - y)};
  }

private:
  int Width;
  int Height;
};

} // namespace inr
