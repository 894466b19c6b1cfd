// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/GpuCache.h"
#include "CUDA/Render/DeviceRenderer.h"
#include "CUDA/Render/DeviceStore.h"

#include <memory>
#include <mutex>
#include <vector>

namespace inr {
namespace cuda {

using GpuStore = DeviceStore<GpuMachine, GpuCache>;

extern template class DeviceRenderer<GpuMachine, GpuCache>;

/// The caches of a model on its GPU, as long as renderers have them: one for those that show it
/// with as many voxels, in the same bricks and precision, and within as many bytes.
class DeviceStores
{
public:
  /// Takes what CacheOptions allow and the GPU's other caches leave, and with these half of the
  /// memory that was free, or theirs, when one of them came: others draw with it, too. Throws
  /// Error(Device) where there is too little of it, and what DeviceCache throws.
  std::shared_ptr<GpuStore> storeFor(const std::shared_ptr<const DeviceModel>& model,
                                     const glm::i64vec3& dims, const CacheOptions& options);

private:
  struct Entry
  {
    glm::i64vec3 dims;
    int brickSize;
    CachePrecision precision;
    std::int64_t bytes; ///< as wanted
    std::weak_ptr<GpuStore> store;
  };

  std::mutex Mutex; ///< guards what follows
  std::vector<Entry> Entries;
};

} // namespace cuda
} // namespace inr
