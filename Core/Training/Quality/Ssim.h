// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace inr {

/// 3D SSIM of two volumes that arrive slice by slice (see MeasureQuality for the definition).
/// Holds seven slices of window sums, whatever the volume's depth; none where no window fits.
class SliceSsim
{
public:
  static constexpr std::int64_t Window = 7; ///< edge in voxels

  /// `size`: voxels of the volumes.
  SliceSsim(const glm::i64vec3& size, const Arena& arena);

  static bool HasWindows(const glm::i64vec3& size)
  {
    return size.x >= Window && size.y >= Window && size.z >= Window;
  }

  /// The next slice of both volumes, normalised; a non-finite reference voxel voids its windows.
  void addSlice(const double* reference, const double* decoded);

  /// Sum of the scores of all windows so far, and their number.
  double total() const { return this->Total; }
  std::int64_t count() const { return this->Windows; }

private:
  /// Reference, decoded, their squares, their product, and the count of void voxels.
  static constexpr int SumCount = 6;
  using Sums = std::array<double, SumCount>;
  using SumPlane = std::vector<Sums>;

  void sumWindows(const double* reference, const double* decoded, SumPlane& plane) const;
  void slide(const SumPlane& entering, const SumPlane* leaving);
  void addColumnScores();

  std::int64_t Width;
  std::int64_t Height;
  const Arena& Threads;
  std::int64_t Slices = 0;
  std::array<SumPlane, Window> Recent;
  SumPlane Columns; ///< window sums over the last seven slices
  double Total = 0;
  std::int64_t Windows = 0;
};

} // namespace inr
