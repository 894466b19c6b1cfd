// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Cache/Requests.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Bricks/SufficientBricks.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// Gradients of the cached field: central differences, one voxel of the sampled level to either
/// side, of the trilinear interpolation. Near the face of a brick the other side is in the next
/// brick, so that gradients do not jump there; at the rim of the volume differences are one-sided.
class BrickGradients
{
public:
  BrickGradients(const SufficientBricks& bricks, const BrickFormat& format,
                 const BrickKernel& kernel)
      : Bricks(bricks), Format(format), Kernel(kernel)
  {}

  /// What a neighbouring brick that is not there means.
  enum class Missing { OneSided, Stop };

  /// Finds those of samples which[0 .. count), which rise, of `batch`. bricks[p] is the brick of
  /// path p. Returns how many were found, fewer than `count` only with Missing::Stop. Bricks that
  /// were not there come out of `requests`; `contribution` is what each is worth.
  int find(const SampleBatch& batch, const BrickKey* bricks, const int* which, int count,
           Missing missing, float contribution, RequestList& requests);

  /// Of the samples found last, per voxel of level 0.
  const GradientBatch& latest() const { return this->Latest; }
  glm::vec3 latest(int sample) const
  {
    const auto& along = this->Latest.along;
    return {along[0][sample], along[1][sample], along[2][sample]};
  }

  std::int64_t found() const { return this->Found; } ///< so far

private:
  /// Samples are moved by one voxel along an axis, up or down.
  struct Move
  {
    int axis;
    int step;
  };
  /// What is wanted of neighbours that are not there.
  struct Wish
  {
    Missing missing;
    float contribution;
    RequestList& requests;
  };

  /// Places along the axis from which a move stays in the brick or has nowhere else to go.
  struct Inside
  {
    float low;
    float high;
  };

  /// Along one axis, of samples whose neighbours may lie in other bricks there, or beyond the
  /// volume. Of how many that was possible.
  int findAtRims(const SampleBatch& batch, const BrickKey* bricks, const int* which, int count,
                 int axis, const Wish& wish, float* differences);
  Inside insideOf(BrickKey brick, const Move& move) const;
  bool movePath(const Move& move, const Wish& wish, BrickKey brick, bool crosses,
                BrickPath& path) const;
  int moveSamples(const SampleBatch& batch, const BrickKey* bricks, const int* which, int count,
                  const Move& move, const Wish& wish);

  /// Multiplies the latest ones' first `count`, per voxel of the sampled level.
  void scaleToFinest(const SampleBatch& batch, const BrickKey* bricks, const int* which, int count);

  GradientBatch Latest{};
  SampleBatch Moved{};                  ///< samples one voxel along
  float Offsets[SampleBatch::Capacity]; ///< by how many voxels really, at the rim of the volume
  const SufficientBricks& Bricks;
  BrickFormat Format;
  const BrickKernel& Kernel;
  std::int64_t Found = 0;
};

} // namespace inr
