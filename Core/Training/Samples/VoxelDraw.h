// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"
#include "Core/Training/Samples/SampleSource.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// Random voxels of a volume in memory, all finite, for estimates of a mean over its finite voxels.
///
/// Half of them, as it were, are drawn uniformly, half in proportion to the contrast around them:
/// the difference of the largest and the smallest value in their block. Where data are localised,
/// a few blocks have nearly all of a model's error, and uniform voxels miss them. The first draws
/// of a stream, however many, are spread evenly: of voxels that are drawn twice, on average,
/// none is left out.
class VoxelDraw
{
public:
  /// Takes one pass over the volume, which has finite voxels and must outlive this.
  VoxelDraw(const NormalisedVolume& volume, const Arena& arena);

  struct Voxel
  {
    glm::i64vec3 at;
    float weight; ///< above 0, at most 2; a mean over voxels times their weights is not biased
  };

  /// Number `k` of a random stream.
  Voxel voxel(std::uint64_t stream, std::uint64_t k) const;

private:
  struct Block
  {
    std::int64_t finite = 0;
    double contrast = 0;
  };

  GridBox box(std::int64_t block) const;
  Block look(std::int64_t block) const;
  double density(const Block& block) const;

  NormalisedVolume Volume;
  std::int64_t Edge;                 ///< of a block
  glm::i64vec3 Counts;               ///< of blocks, per axis
  double Finite = 0;                 ///< voxels
  double Contrast = 0;               ///< around them, in all
  std::vector<double> Probabilities; ///< of each block and those before
};

} // namespace inr
