// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/EvaluateKernel.h"
#include "Core/Parallel.h"
#include "Core/Training/SampleSource.h"
#include "Core/Training/StopCheck.h"

#include <cstdint>
#include <vector>

namespace inr {

/// PSNR of a network in training, on a fixed set of random voxels: the quality of a file is
/// measured at voxels, too.
class PsnrEstimate
{
public:
  static constexpr std::int64_t UsualVoxels = 1 << 15;
  static constexpr std::int64_t StoringVoxels = 4 * UsualVoxels; ///< where a tenth of a dB counts

  /// `arena` evaluates networks; it must outlive this.
  PsnrEstimate(const SampleSource& source, std::uint64_t seed, const Arena& arena,
               std::int64_t voxels = UsualVoxels);

  /// The same from targets at the first of positions().
  PsnrEstimate(std::vector<glm::vec3> positions, std::vector<float> targets, const Arena& arena);

  /// Centres of the random voxels: fewer are the first of more.
  static std::vector<glm::vec3> positions(const glm::i64vec3& dims, std::uint64_t seed,
                                          std::int64_t voxels);

  std::int64_t voxels() const { return static_cast<std::int64_t>(this->Targets.size()); }

  /// The same on the first `voxels` alone, of which there are so many.
  PsnrEstimate first(std::int64_t voxels) const;

  /// In dB, peak 1; infinity for a perfect fit, 0 when `check` stopped it or no target is finite.
  double measure(const ModelView& model, const EvaluateKernel& kernel,
                 const StopCheck& check) const;

  /// Normalised outputs at these voxels; unfinished when `check` stopped it.
  std::vector<float> values(const ModelView& model, const EvaluateKernel& kernel,
                            const StopCheck& check) const;

  /// CRC-32 of the voxels' values: says whether two estimates are of the same data.
  std::uint32_t checksum() const;

  /// Mean squared difference of `values` from the targets, over those that are finite; 0 where none
  /// is.
  double squaredError(const std::vector<float>& values) const;

private:
  void evaluate(const ModelView& model, const EvaluateKernel& kernel, const StopCheck& check,
                std::int64_t begin, std::int64_t end, float* values) const;

  const Arena& Threads;
  std::vector<glm::vec3> Positions;
  std::vector<float> Targets;
  std::int64_t Known = 0; ///< targets that are finite
};

} // namespace inr
