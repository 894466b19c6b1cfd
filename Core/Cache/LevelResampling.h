// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/ValueBox.h"

#include <glm/gtc/type_precision.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace inr {

/// Level 0 made to look like a coarser one: what that has, linear between its voxels, each of which
/// is the mean of 2 x 2 x 2 points that are linear between voxels of level 0. This is a product of
/// three sums, one along each axis.
class LevelResampling
{
public:
  /// For voxels `seen` of a volume of `dims`, as `level` of its Hierarchy has them.
  LevelResampling(const VoxelSpan (&seen)[3], const glm::i64vec3& dims, int level);

  /// Of level 0 that they are made of, those seen among them.
  VoxelSpan needed(int axis) const { return this->Needed[axis]; }

  /// What the level has at the voxels seen. `fine` begins at voxel `first` of level 0 and holds all
  /// that is needed.
  ValueBox apply(const ValueBox& fine, const glm::i64vec3& first) const;

private:
  /// The voxels of level 0 that make up one of the level, seen from a voxel of level 0.
  struct Taps
  {
    std::array<std::int64_t, 8> voxel;
    std::array<float, 8> weight;
  };

  static Taps tapsOf(std::int64_t voxel, std::int64_t size, std::int64_t coarseSize);
  static ValueBox alongX(const ValueBox& in, const std::vector<Taps>& taps, std::int64_t first);
  static ValueBox across(const ValueBox& in, int axis, const std::vector<Taps>& taps,
                         std::int64_t first);

  VoxelSpan Needed[3];
  std::vector<Taps> Sums[3];
};

} // namespace inr
