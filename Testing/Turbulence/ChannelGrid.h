// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"
#include "Testing/Turbulence/ChannelKernel.h"
#include "Testing/Turbulence/PhaseTable.h"
#include "Testing/Turbulence/TurbulentChannel.h"

#include <glm/gtc/type_precision.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace inr {

/// The field at the voxels of a grid: voxel i of n sits at (i + 0.5)/n in the unit cube. Immutable:
/// any number of threads may use one at once.
///
/// A voxel's value depends on nothing but the field, the grid and the voxel: rows, parts of rows
/// and single voxels, asked for in any order on any processor, give the same bits. They are a few
/// ulps from TurbulentChannel::at.
class ChannelGrid
{
public:
  /// 1 to 2^20 voxels per axis. `kernel` asks for an instruction set by name (for tests). Throws
  /// Error(InvalidArgument).
  ChannelGrid(const TurbulentChannel& field, const glm::i64vec3& dims,
              const std::string& kernel = "");

  const glm::i64vec3& dims() const { return this->Dims; }

  /// What the rows at one z share.
  struct Plane
  {
    std::int64_t k = -1;
    double mean = 0;
    std::vector<double> cosines;
    std::vector<double> sines;
  };
  /// That at `k`: out of a table or, for grids of many planes, made in `scratch`, which takes some
  /// ten microseconds unless it is there already.
  const Plane& plane(std::int64_t k, Plane& scratch) const;

  /// Values of the voxels [first, first + count) of row `j` of `plane`, rounded to T: float or
  /// double. A row costs what 100 voxels do, on top.
  template <class T>
  void row(const Plane& plane, std::int64_t j, std::int64_t first, std::int64_t count,
           T* values) const;

  /// The voxels [begin, begin + size), x fastest, likewise.
  template <class T>
  void box(const Arena& arena, const glm::i64vec3& begin, const glm::i64vec3& size,
           T* values) const;

private:
  Plane makePlane(std::int64_t k) const;
  template <class T>
  void rows(const glm::i64vec3& begin, const glm::i64vec3& size, std::int64_t firstRow,
            std::int64_t endRow, T* values) const;

  TurbulentChannel Field;
  glm::i64vec3 Dims;
  const ChannelKernel& Kernel;
  PhaseTable Streamwise;
  PhaseTable Spanwise;
  std::vector<Plane> Planes; ///< all, or none where they are many
  /// From a tile's first voxel to its others, by wave; aligned as vectors are.
  using WaveTable = std::array<double, ChannelWaves * ChannelTile>;
  alignas(64) WaveTable WaveCosines;
  alignas(64) WaveTable WaveSines;
};

} // namespace inr
