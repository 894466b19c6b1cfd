// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cstdint>

namespace inr {

/// Pixels of a rectangle, as far apart as that they are `across` or fewer across and down.
class PixelGrid
{
public:
  PixelGrid(const glm::ivec2& first, const glm::ivec2& size, int across)
      : First(first), Size(size), Apart((std::max(size.x, size.y) + across - 1) / across),
        Across((size.x + this->Apart - 1) / this->Apart),
        Down((size.y + this->Apart - 1) / this->Apart)
  {}
  int apart() const { return this->Apart; }
  std::int64_t count() const { return this->Across * this->Down; }
  glm::ivec2 pixel(std::int64_t number) const
  {
    const glm::ivec2 place(number % this->Across, number / this->Across);
    return this->First + glm::min(place * this->Apart + this->Apart / 2, this->Size - 1);
  }

private:
  glm::ivec2 First;
  glm::ivec2 Size;
  int Apart;
  std::int64_t Across;
  std::int64_t Down;
};

} // namespace inr
