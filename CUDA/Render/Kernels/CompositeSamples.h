// SPDX-License-Identifier: BSD-3-Clause
//
// The light of a few samples of a ray, added up front to back. What they have in common is copied
// before, so that it stays in registers, and their voxels are read group by group, so that none
// waits for another one's.
#pragma once

#include "CUDA/Render/Kernels/BrickSampling.h"
#include "CUDA/Render/Kernels/GatheredLight.h"
#include "CUDA/Render/Kernels/RenderScene.h"
#include "Core/Render/Marching/RayMarching.h"

namespace inr {
namespace cuda {

/// A brick, and how samples are read from it: sample k is at (start + k * spacing) + offset along
/// its path.
struct SampledBrick
{
  BrickPath path;
  float start;
  ValueRange range; ///< that values can have
};

/// Samples that differ in nothing but their place and, where levels are mixed, their brick.
struct AlikeRow
{
  int count;
  float spacing; ///< in steps
  float offset;
  int length; ///< that each stands for; see FindColor
};

/// What came of such samples.
struct CompositedRow
{
  GatheredLight light;  ///< of all so far
  bool halfOpaque;      ///< whether it holds back one half
  int halfOpaqueAt = 0; ///< the sample that did
  std::uint32_t clamped = 0;
  int taken[2] = {};  ///< samples, from the first brick and from the second
  float seen[2] = {}; ///< light that is let through by each of these, summed up

  INR_HOST_DEVICE int count() const { return this->taken[0] + this->taken[1]; }
};

/// Adds the light of a row of samples of a scene that is not lit, until all are past or the ray is
/// opaque. `Bricks`: OneBrick or TwoBricks.
template <class Bricks> class RowCompositor
{
public:
  INR_HOST_DEVICE RowCompositor(const CacheView& cache, const RenderScene& scene,
                                const AlikeRow& row, const Bricks& bricks)
      : Cache(cache), Colors(scene.colors), Steps(scene.steps), Row(row), From(bricks),
        Units(UnitsOf(scene.steps, row.length))
  {}

  INR_HOST_DEVICE void add(CompositedRow& sum) const
  {
    while (sum.count() < this->Row.count && !sum.light.isOpaque()) {
      const int first = sum.count();
      StepColor colors[GroupSize];
      bool clamps[GroupSize];
      this->look(first, colors, clamps);
      for (int k = 0; k < GroupSize; ++k) {
        if (first + k < this->Row.count && !sum.light.isOpaque()) {
          this->addOne(first + k, colors[k].color(this->Units), sum);
          sum.clamped += clamps[k] ? 1 : 0;
        }
      }
    }
  }

private:
  static constexpr int GroupSize = 4;

  /// What a group of samples shows; behind the last sample anything.
  INR_HOST_DEVICE void look(int first, StepColor (&colors)[GroupSize],
                            bool (&clamps)[GroupSize]) const
  {
    StoredPlace places[GroupSize];
    for (int k = 0; k < GroupSize; ++k) {
      places[k] = this->placeOf(glm::min(first + k, this->Row.count - 1));
    }
    float values[GroupSize];
    FindStored(this->Cache, places, values);
    for (int k = 0; k < GroupSize; ++k) {
      const SampledBrick& brick = this->From.brick(glm::min(first + k, this->Row.count - 1));
      const float found = fmaf(values[k], brick.path.quantum, brick.path.base);
      values[k] = fminf(fmaxf(found, brick.range.low), brick.range.high);
      clamps[k] = std::abs(found - values[k]) > RoundingOfStorage;
    }
    for (int k = 0; this->Colors.logarithmic && k < GroupSize; ++k) {
      values[k] = this->Colors.coordinate(values[k]);
    }
    for (int k = 0; k < GroupSize; ++k) {
      colors[k] = FindColor(this->Steps, this->Row.length, values[k]);
    }
  }

  INR_HOST_DEVICE StoredPlace placeOf(int k) const
  {
    const SampledBrick& brick = this->From.brick(k);
    const float along =
        (brick.start + static_cast<float>(k) * this->Row.spacing) + this->Row.offset;
    return {brick.path.voxels, FindCellOn(this->Cache, brick.path, along)};
  }

  INR_HOST_DEVICE void addOne(int k, const glm::vec4& color, CompositedRow& sum) const
  {
    sum.light.add(color, color.w);
    if (!sum.halfOpaque && sum.light.isHalfOpaque()) {
      sum.halfOpaque = true;
      sum.halfOpaqueAt = k;
    }
    const int number = this->From.numberOf(k);
    ++sum.taken[number];
    sum.seen[number] += sum.light.through();
  }

  const CacheView& Cache;
  const ColorLookup& Colors;
  StepLookup Steps;
  AlikeRow Row;
  const Bricks& From;
  float Units; ///< of each sample's length
};

/// A row in a single brick.
struct OneBrick
{
  SampledBrick only;

  INR_HOST_DEVICE int numberOf(int) const { return 0; }
  INR_HOST_DEVICE const SampledBrick& brick(int) const { return this->only; }
};

/// A row in bricks of two levels.
struct TwoBricks
{
  SampledBrick both[2];
  std::uint32_t second; ///< bit k: sample k is from the second

  INR_HOST_DEVICE int numberOf(int k) const { return static_cast<int>(this->second >> k & 1u); }
  INR_HOST_DEVICE const SampledBrick& brick(int k) const { return this->both[this->numberOf(k)]; }
};

} // namespace cuda
} // namespace inr
