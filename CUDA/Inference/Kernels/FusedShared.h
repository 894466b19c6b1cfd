// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {
namespace cuda {

/// How many rows of the grid's lattice a block has room for: of all that its samples touch, and of
/// those at the z of one layer of samples.
struct RowRoom
{
  std::int32_t rows;
  std::int32_t ofLayer;
};

/// Where a fused kernel has what in its block's shared memory, in bytes.
struct FusedShared
{
  bool keepsWeights;        ///< a copy of them comes first
  std::int32_t rows;        ///< points only: 32 encoded rows per warp
  std::int32_t results;     ///< one per sample
  std::int32_t coordinates; ///< bricks only: of samples along each axis
  std::int32_t parts;       ///< and a LevelPart per level
  std::int32_t lattice;     ///< and rows of the lattice
  std::int32_t mixed;       ///< and of layers of samples
  std::int32_t end;         ///< = all that is needed
  RowRoom room;
};

} // namespace cuda
} // namespace inr
