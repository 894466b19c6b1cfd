// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Volume.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// Where training targets come from. Safe to ask from several threads at once.
class SampleSource
{
public:
  virtual ~SampleSource() = default;

  /// Normalised trilinear values at `count` positions in the unit cube: voxel i of n sits at
  /// (i + 0.5)/n, positions beyond the outermost voxel centres are clamped to them. NaN where a
  /// voxel of the cell is NaN or infinite.
  virtual void sample(const glm::vec3* positions, std::int64_t count, float* targets) const = 0;
};

/// The whole volume in memory, in its own type.
class InMemorySource : public SampleSource
{
public:
  /// Values are normalised to (v - low)/(high - low); low < high. `volume` must outlive this.
  InMemorySource(const VolumeData& volume, double low, double high);

  void sample(const glm::vec3* positions, std::int64_t count, float* targets) const override;

private:
  VolumeData Volume;
  double Low;
  double Scale;
};

} // namespace inr
