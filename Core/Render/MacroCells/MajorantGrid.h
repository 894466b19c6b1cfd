// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"
#include "Core/Render/MacroCells/CellVisibility.h"
#include "Core/Render/MacroCells/EmptySpace.h"
#include "Core/Render/MacroCells/MajorantView.h"

#include <cstdint>
#include <vector>

namespace inr {

class Arena;

/// A grid of value ranges joined with what makes values visible, a transfer function say.
class MajorantGrid
{
public:
  /// `cells` must not be empty.
  explicit MajorantGrid(MacroCells cells);
  MajorantGrid(MajorantGrid&&) noexcept = default;
  MajorantGrid& operator=(MajorantGrid&&) noexcept = default;

  /// Recomputes every cell's extinction: by a rule, or for compositing.
  void update(const ExtinctionRule& rule, const Arena& arena);
  void update(const ColorTable& colors, const Arena& arena)
  {
    this->update(VisibilityFor({}, colors), arena);
  }

  /// What walks read, for as long as this lives, or what it is moved to.
  const MajorantGridView& view() const { return this->View; }

  const glm::i64vec3& dims() const { return this->View.dims(); }
  const glm::dvec3& spacing() const { return this->View.spacing(); }
  std::int64_t count() const { return this->View.count(); }
  std::int64_t index(const glm::i64vec3& at) const { return this->View.index(at); }
  const ValueRange& range(std::int64_t cell) const { return this->View.range(cell); }
  float extinction(std::int64_t cell) const { return this->View.extinction(cell); }
  int emptyBlock(std::int64_t cell) const { return this->View.emptyBlock(cell); }

private:
  MacroCells Cells;
  std::vector<float> Extinctions; ///< apart: empty space is left by looking at nothing else
  EmptySpace Empty;
  MajorantGridView View; ///< of these
};

} // namespace inr
