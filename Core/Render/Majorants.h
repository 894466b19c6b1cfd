// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"
#include "Core/Render/ColorTable.h"
#include "Core/Render/EmptySpace.h"

#include <cstdint>
#include <vector>

namespace inr {

class Arena;

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
  /// Cells are numbered x fastest.
  std::int64_t index(const glm::i64vec3& at) const
  {
    return at.x + this->Dims.x * (at.y + this->Dims.y * at.z);
  }
  const ValueRange& range(std::int64_t cell) const
  {
    return this->Ranges[static_cast<std::size_t>(cell)];
  }
  /// -ln(1 - a) for the largest opacity a (per unit distance) of any value in the cell's range; 0 =
  /// invisible.
  float extinction(std::int64_t cell) const
  {
    return this->Extinctions[static_cast<std::size_t>(cell)];
  }

  /// The largest aligned block of invisible cells around a cell has 2^k cells per axis; -1 = the
  /// cell is visible.
  int emptyBlock(std::int64_t cell) const { return this->Empty.block(cell); }

private:
  glm::i64vec3 Dims;
  glm::dvec3 Spacing;
  std::vector<ValueRange> Ranges;
  std::vector<float> Extinctions; ///< apart: empty space is left by looking at nothing else
  EmptySpace Empty;
};

} // namespace inr
