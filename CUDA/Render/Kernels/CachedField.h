// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/Kernels/BrickSampling.h"
#include "CUDA/Render/Kernels/RayCounts.h"
#include "Core/Render/Bricks/OnMiss.h"
#include "Core/Render/Paths/FieldPoint.h"

namespace inr {
namespace cuda {

/// The field at points as the cache has it, for paths; Core's CachedSampler of one point.
class CachedField
{
public:
  INR_HOST_DEVICE CachedField(const CacheView& cache, OnMiss onMiss, RayCounts& counts)
      : Cache(cache), Missing(onMiss), Counts(counts)
  {}

  /// False where the path stops for a brick.
  INR_HOST_DEVICE bool find(const FieldPoint& point, float& value)
  {
    const glm::dvec3 index = glm::dvec3(point.voxel) + glm::dvec3(point.fraction);
    const BrickLocation wanted = this->Cache.hierarchy.locate(point.level, index);
    const BrickKey key = KeyOf(wanted.brick);
    const std::int32_t slot = this->Cache.find(key);
    if (slot >= 0) {
      value = this->read(slot, wanted.local, point.level);
      return true;
    }
    if (this->Missing == OnMiss::Stop) {
      this->Cache.request(key, 1.0f);
      return false;
    }
    value = this->findCoarser(point.level, index, key);
    return true;
  }

private:
  INR_HOST_DEVICE float findCoarser(int wanted, const glm::dvec3& index, BrickKey wish)
  {
    ++this->Counts.missed;
    BrickKey next = wish;
    for (int level = wanted + 1;; ++level) { // the coarsest is there
      const BrickLocation served = this->Cache.hierarchy.locate(level, index);
      const std::int32_t slot = this->Cache.find(KeyOf(served.brick));
      if (slot >= 0) {
        this->Cache.request(this->Missing == OnMiss::Approach ? next : wish, 1.0f);
        return this->read(slot, served.local, level);
      }
      next = this->Cache.hierarchy.isOnTheWay(level) ? KeyOf(served.brick) : next;
    }
  }

  INR_HOST_DEVICE float read(std::int32_t slot, const glm::dvec3& local, int level)
  {
    this->Cache.touch(slot);
    ++this->Counts.samples;
    this->Counts.levels |= 1u << level;
    return Interpolated(this->Cache, this->Cache.view(slot), FindCell(this->Cache, local));
  }

  const CacheView& Cache;
  OnMiss Missing;
  RayCounts& Counts;
};

} // namespace cuda
} // namespace inr
