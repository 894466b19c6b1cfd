// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/EvaluateKernel.h"
#include "Core/Parallel.h"
#include "Core/Training/Runtime/StopCheck.h"
#include "Core/Training/Samples/SampleSource.h"

#include <cstdint>
#include <vector>

namespace inr {

/// PSNR of a network in training, on a fixed set of random voxels: the quality of a file is
/// measured at voxels, too. Of a volume in memory they are those of VoxelDraw; of any other they
/// are uniform, of whatever value, and may miss what is localised.
class PsnrEstimate
{
public:
  static constexpr std::int64_t UsualVoxels = 1 << 15;
  static constexpr std::int64_t StoringVoxels = 4 * UsualVoxels; ///< where a tenth of a dB counts

  /// `arena` evaluates networks; it must outlive this.
  PsnrEstimate(const SampleSource& source, std::uint64_t seed, const Arena& arena,
               std::int64_t voxels = UsualVoxels);

  /// From targets at the first of positions().
  PsnrEstimate(std::vector<glm::vec3> positions, std::vector<float> targets, const Arena& arena);

  /// Centres of uniform random voxels: fewer are the first of more.
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

  /// Whether the network says the same at all of these voxels, to the bit, though they differ: then
  /// all neurons of a layer are off, and no gradient leads away from that. Not where `check`
  /// stopped it.
  bool isStuck(const ModelView& model, const EvaluateKernel& kernel, const StopCheck& check) const;

  /// CRC-32 of the voxels' values: says whether two estimates are of the same data.
  std::uint32_t checksum() const;

  /// Mean squared difference of `values` from the targets, over those that are finite; 0 where none
  /// is.
  double squaredError(const std::vector<float>& values) const;

  /// That of the constant with the least.
  double squaredErrorOfConstant() const;

  /// Mean squared difference of values from others.
  double squaredDifference(const std::vector<float>& a, const std::vector<float>& b) const;

  /// Targets that are finite, on which all of this depends.
  std::int64_t known() const { return this->Known; }

private:
  struct Choice
  {
    std::vector<glm::vec3> positions;
    std::vector<float> weights; ///< empty = 1 each
  };
  static Choice Choose(const SampleSource& source, std::uint64_t seed, const Arena& arena,
                       std::int64_t voxels);

  PsnrEstimate(Choice choice, std::vector<float> targets, const Arena& arena);
  PsnrEstimate(const Choice& choice, const SampleSource& source, const Arena& arena);

  double weight(std::size_t k) const { return this->Weights.empty() ? 1.0 : this->Weights[k]; }
  void evaluate(const ModelView& model, const EvaluateKernel& kernel, const StopCheck& check,
                std::int64_t begin, std::int64_t end, float* values) const;

  const Arena& Threads;
  std::vector<glm::vec3> Positions;
  std::vector<float> Weights;
  std::vector<float> Targets;
  std::int64_t Known = 0; ///< targets that are finite
};

} // namespace inr
