// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/GridBox.h"
#include "Core/HostDevice.h"
#include "Core/Model/MacroCells.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// A MajorantGrid as plain data, whose arrays lie in the memory of whoever reads it.
class MajorantGridView
{
public:
  MajorantGridView() = default; ///< of no cells
  /// Of each cell its range, extinction and 1 + k of its empty block, or 0; see below.
  INR_HOST_DEVICE MajorantGridView(const glm::i64vec3& dims, const glm::dvec3& spacing,
                                   const ValueRange* ranges, const float* extinctions,
                                   const std::uint8_t* blocks)
      : Dims(dims), Spacing(spacing), Ranges(ranges), Extinctions(extinctions), Blocks(blocks)
  {}

  INR_HOST_DEVICE const glm::i64vec3& dims() const { return this->Dims; }
  INR_HOST_DEVICE const glm::dvec3& spacing() const { return this->Spacing; }
  INR_HOST_DEVICE std::int64_t count() const { return GridCount(this->Dims); }
  /// Cells are numbered x fastest.
  INR_HOST_DEVICE std::int64_t index(const glm::i64vec3& at) const
  {
    return GridNumber(at, this->Dims);
  }
  INR_HOST_DEVICE const ValueRange& range(std::int64_t cell) const { return this->Ranges[cell]; }
  /// Where opacity decides, -ln(1 - a) for the largest opacity a (per unit distance) of any value
  /// in the cell's range; 0 = invisible.
  INR_HOST_DEVICE float extinction(std::int64_t cell) const { return this->Extinctions[cell]; }
  /// The largest aligned block of invisible cells around a cell has 2^k cells per axis; -1 = the
  /// cell is visible.
  INR_HOST_DEVICE int emptyBlock(std::int64_t cell) const { return this->Blocks[cell] - 1; }

  /// The arrays, for copies of them.
  const ValueRange* ranges() const { return this->Ranges; }
  const float* extinctions() const { return this->Extinctions; }
  const std::uint8_t* blocks() const { return this->Blocks; }

private:
  glm::i64vec3 Dims{0};
  glm::dvec3 Spacing{0};
  const ValueRange* Ranges = nullptr;
  const float* Extinctions = nullptr;
  const std::uint8_t* Blocks = nullptr;
};

/// Majorants as plain data.
class MajorantsView
{
public:
  /// Of numbers of cells that 64 bits can hold.
  static constexpr int MostGrids = 34;

  INR_HOST_DEVICE int grids() const { return this->Count; }
  INR_HOST_DEVICE const MajorantGridView& grid(int number) const { return this->Grids[number]; }
  /// See Majorants.
  INR_HOST_DEVICE int coarsestLevel(int grid) const { return this->Coarsest[grid]; }
  /// Number of the finest grid that bounds a level.
  INR_HOST_DEVICE int gridFor(int level) const
  {
    int grid = 0;
    while (grid + 1 < this->Count && this->Coarsest[grid] < level) {
      ++grid;
    }
    return grid;
  }

  /// At most MostGrids, from fine to coarse.
  void add(const MajorantGridView& grid, int coarsestLevel)
  {
    this->Grids[this->Count] = grid;
    this->Coarsest[this->Count++] = coarsestLevel;
  }
  void boundTo(int grid, int coarsestLevel) { this->Coarsest[grid] = coarsestLevel; }

private:
  int Count = 0;
  MajorantGridView Grids[MostGrids];
  int Coarsest[MostGrids] = {};
};

} // namespace inr
