// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Tolerance/ValueBox.h"

#include <glm/gtc/type_precision.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace inr {

/// What a coarser level has at voxels of level 0: linear between its own voxels. Where those are
/// means of 2 x 2 x 2 points, these are taken to be linear between voxels of level 0. This is a
/// product of three sums, one along each axis.
class LevelResampling
{
public:
  /// For voxels `seen` of a volume of `dims`, as `level` of its Hierarchy has them. `points`: of a
  /// voxel of the level, per axis.
  LevelResampling(const VoxelSpan (&seen)[3], const glm::i64vec3& dims, int level, int points);

  /// Voxels that all is made of: of level 0, those seen among them, or where the level's are points
  /// of the level itself.
  VoxelSpan needed(int axis) const { return this->Needed[axis]; }

  /// What the level has at the voxels seen. `voxels` begin at voxel `first` and hold all that is
  /// needed.
  ValueBox apply(const ValueBox& voxels, const glm::i64vec3& first) const;

private:
  /// Those that make up what the level has at a voxel of level 0.
  struct Taps
  {
    std::array<std::int64_t, 8> voxel; ///< the first `count` of them
    std::array<float, 8> weight;
    std::size_t count;

    void add(std::int64_t tap, double share)
    {
      this->voxel[this->count] = tap;
      this->weight[this->count] = static_cast<float>(share);
      ++this->count;
    }
  };

  /// At a place in the level's `coarseSize` voxels, where level 0 has `size`.
  static Taps meansAt(double place, std::int64_t size, std::int64_t coarseSize);
  static Taps pointsAt(double place, std::int64_t coarseSize);
  static ValueBox alongX(const ValueBox& in, const std::vector<Taps>& taps, std::int64_t first);
  static ValueBox across(const ValueBox& in, int axis, const std::vector<Taps>& taps,
                         std::int64_t first);

  VoxelSpan Needed[3];
  std::vector<Taps> Sums[3];
};

} // namespace inr
