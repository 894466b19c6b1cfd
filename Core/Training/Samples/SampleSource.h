// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Samples/Trilinear.h"
#include "Core/Training/Volume/Volume.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>

namespace inr {

/// A volume in memory and what is target 0 and 1 of it.
struct NormalisedVolume
{
  VolumeData data;
  double low;
  double high;
};

/// Where training targets come from. Safe to ask from several threads at once.
class SampleSource
{
public:
  virtual ~SampleSource() = default;

  /// Voxels per axis.
  virtual const glm::i64vec3& dims() const = 0;

  /// Normalised trilinear values at `count` positions in the unit cube: voxel i of n sits at
  /// (i + 0.5)/n, positions beyond the outermost voxel centres are clamped to them. In a cell with
  /// a voxel that is NaN or infinite the nearest voxel's value, so that every finite voxel is a
  /// target; NaN where that one is not finite.
  virtual void sample(const glm::vec3* positions, std::int64_t count, float* targets) const = 0;

  /// The voxels, where they lie in memory, all of them: for a device that samples a copy.
  virtual std::optional<NormalisedVolume> inMemory() const { return std::nullopt; }
};

/// Random position number `k` of a stream: uniform in the unit cube, but in the middle of an axis
/// of a single voxel, where nothing changes and nothing else is ever asked for.
glm::vec3 RandomPosition(std::uint64_t stream, std::uint64_t k, const glm::i64vec3& dims);

/// What SampleSource gives of a volume of `dims` voxels before it is normalised, at positions
/// whose voxels `piece` holds: above `origin`, which is subtracted first, so that small differences
/// of large values are interpolated as exactly as if they were those of small ones.
void SamplePiece(const VolumePiece& piece, const glm::i64vec3& dims, const glm::vec3* positions,
                 std::int64_t count, double origin, double* values);

/// The same, normalised to (v - low)/(high - low).
void SampleNormalised(const VolumePiece& piece, const glm::i64vec3& dims,
                      const glm::vec3* positions, std::int64_t count, double low, double high,
                      float* targets);

/// The whole volume in memory, in its own type.
class InMemorySource : public SampleSource
{
public:
  /// Values are normalised to (v - low)/(high - low); low < high. `volume` must outlive this.
  InMemorySource(const VolumeData& volume, double low, double high);

  const glm::i64vec3& dims() const override { return this->Volume.data.dims; }
  void sample(const glm::vec3* positions, std::int64_t count, float* targets) const override;
  std::optional<NormalisedVolume> inMemory() const override
  {
    return NormalisedVolume{this->Volume.data, this->Low, this->High};
  }

private:
  VolumePiece Volume;
  double Low;
  double High;
};

} // namespace inr
