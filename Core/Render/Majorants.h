// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"
#include "Core/Render/ColorTable.h"

#include <cstdint>
#include <vector>

namespace inr {

class Arena;

/// One macro-cell as the ray marcher sees it.
struct MajorantCell
{
  ValueRange range;
  /// -ln(1 - a) for the largest opacity a (per unit distance) of any value in `range`; 0 =
  /// invisible.
  float extinction = 0;
};

/// Value ranges joined with a transfer function. Space without a range table (files that lack one)
/// is one cell that may hold anything.
class Majorants
{
public:
  explicit Majorants(const MacroCells& cells);

  /// Recomputes every cell's extinction.
  void update(const ColorTable& colors, const Arena& arena);

  const glm::i64vec3& dims() const { return this->Dims; }
  const glm::dvec3& spacing() const { return this->Spacing; }
  const MajorantCell& cell(const glm::i64vec3& at) const
  {
    return this
        ->Cells[static_cast<std::size_t>(at.x + this->Dims.x * (at.y + this->Dims.y * at.z))];
  }

private:
  glm::i64vec3 Dims;
  glm::dvec3 Spacing;
  std::vector<MajorantCell> Cells;
};

} // namespace inr
