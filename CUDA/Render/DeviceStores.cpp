// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Render/DeviceStores.h"

#include "CUDA/Render/Renderers.h"

#include <algorithm>

namespace inr {
namespace cuda {

template class DeviceRenderer<GpuMachine, GpuCache>;

std::shared_ptr<GpuStore> DeviceStores::storeFor(const std::shared_ptr<const DeviceModel>& model,
                                                 const glm::i64vec3& dims,
                                                 const CacheOptions& options)
{
  constexpr std::int64_t mostScratch = 64 << 20; // bytes, for inference
  const std::int64_t wanted = options.bytes > 0 ? options.bytes : DefaultCacheBytes();
  const std::lock_guard<std::mutex> lock(this->Mutex);
  const auto isGone = [](const Entry& entry) { return entry.store.expired(); };
  this->Entries.erase(std::remove_if(this->Entries.begin(), this->Entries.end(), isGone),
                      this->Entries.end());
  for (const Entry& entry : this->Entries) {
    std::shared_ptr<GpuStore> store = entry.store.lock();
    if (store && entry.dims == dims && entry.brickSize == options.brickSize &&
        entry.precision == options.precision && entry.bytes == wanted) {
      return store;
    }
  }
  const int device = model->device().ordinal;
  const std::shared_ptr<CacheShares> shares = CacheShares::ofGpu(device);
  const std::int64_t free = FreeMemory(device);
  const std::int64_t limit = std::min(wanted, (free + shares->taken()) / 2);
  const ModelPointer& source = model->source();
  auto store = MakeSharingStore<GpuMachine, GpuCache>(
      shares, device, DeviceInference(model, std::min(limit / 16, mostScratch)),
      Hierarchy(dims, options.brickSize, ResolutionOf(*source)), options.precision, limit,
      source->macroCells, free / 2);
  this->Entries.push_back({dims, options.brickSize, options.precision, wanted, store});
  return store;
}

std::shared_ptr<DeviceStores> MakeStores() { return std::make_shared<DeviceStores>(); }

std::shared_ptr<AcceleratedRenderer> MakeRenderer(const std::shared_ptr<const DeviceModel>& model,
                                                  DeviceStores& stores, const glm::i64vec3& dims,
                                                  const CacheOptions& options)
{
  return std::make_shared<DeviceRenderer<GpuMachine, GpuCache>>(
      stores.storeFor(model, dims, options), options);
}

} // namespace cuda
} // namespace inr
