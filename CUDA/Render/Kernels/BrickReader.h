// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/Kernels/BrickSampling.h"
#include "Core/Render/Bricks/BrickWay.h"
#include "Core/Render/Bricks/OnMiss.h"
#include "Core/Render/Marching/StepLattice.h"

#include <cmath>

namespace inr {
namespace cuda {

/// The brick that a ray's samples of a level are read from, and the ray's way to the next one. Of
/// one ray, whose places count steps of t and do not fall.
class BrickReader
{
public:
  /// How many of at most `most` samples of `level`, from `place` on and `spacing` = 1 / inverse
  /// apart, are read from the brick that is open.
  INR_HOST_DEVICE int covered(int level, double place, double inverse, int most) const
  {
    return level == this->Level && place < this->Exit
               ? CountBelow((this->Exit - place) * inverse, most)
               : 0;
  }

  /// Opens the brick of such a sample or, unless the ray is to stop where that is not there, the
  /// next coarser one that is; the coarsest always is. False where the ray stops: then wish() says
  /// for what. `step`: t between places.
  INR_HOST_DEVICE bool open(const CacheView& cache, const Ray& ray, int level, double place,
                            double step, OnMiss onMiss)
  {
    if (this->Wanted.level() != level) {
      this->Wanted = BrickWay(cache.hierarchy, level, ray);
    }
    this->Wanted.moveTo(place * step);
    this->Level = level;
    this->Wish = this->Wanted.brick();
    const std::int32_t slot = cache.find(this->Wish);
    if (slot >= 0) {
      this->enter(cache, this->Wanted, slot, step);
      return true;
    }
    if (onMiss == OnMiss::Stop) {
      this->Level = -1;
      return false;
    }
    this->openCoarser(cache, ray, place, step, onMiss);
    return true;
  }

  /// Steps along path() at a place: exactly that, if it is a whole number.
  INR_HOST_DEVICE float along(double place) const
  {
    return static_cast<float>(place - this->Reference);
  }
  INR_HOST_DEVICE const BrickPath& path() const { return this->Path; }
  INR_HOST_DEVICE BrickKey served() const { return this->Served; }
  INR_HOST_DEVICE int servedLevel() const { return this->ServedLevel; }
  INR_HOST_DEVICE bool exact() const { return this->ServedLevel == this->Level; }
  /// The brick to load, where this is not the wanted one.
  INR_HOST_DEVICE BrickKey wish() const { return this->Wish; }

private:
  INR_HOST_DEVICE void openCoarser(const CacheView& cache, const Ray& ray, double place,
                                   double step, OnMiss onMiss)
  {
    BrickKey next = this->Wish;
    for (int level = this->Level + 1;; ++level) {
      BrickWay served(cache.hierarchy, level, ray);
      served.moveTo(place * step);
      const std::int32_t slot = cache.find(served.brick());
      if (slot >= 0) {
        this->Wish = onMiss == OnMiss::Approach ? next : this->Wish;
        this->enter(cache, served, slot, step);
        return;
      }
      next = cache.hierarchy.isOnTheWay(level) ? served.brick() : next;
    }
  }

  INR_HOST_DEVICE void enter(const CacheView& cache, const BrickWay& served, std::int32_t slot,
                             double step)
  {
    cache.touch(slot);
    const double inverse = 1.0 / step;
    this->Exit = glm::min(this->Wanted.exit(), served.exit()) * inverse;
    this->Reference = std::floor(served.enter() * inverse);
    this->Served = served.brick();
    this->ServedLevel = served.level();
    served.findPath(this->Reference * step, step, this->Path);
    const BrickView view = cache.view(slot);
    this->Path.voxels = view.voxels;
    this->Path.base = view.low;
    this->Path.quantum = view.step;
  }

  BrickWay Wanted;
  BrickPath Path{};
  double Exit = 0;      ///< a place
  double Reference = 0; ///< where the path begins, a whole number
  BrickKey Served = 0;
  BrickKey Wish = 0;
  int ServedLevel = -1;
  int Level = -1;
};

} // namespace cuda
} // namespace inr
