// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/CudaAccelerator.h"

#include "CUDA/Render/Renderers.h"

#include <algorithm>
#include <mutex>
#include <type_traits>
#include <utility>
#include <vector>

namespace inr {
namespace cuda {

namespace {

class CudaAccelerator : public Accelerator
{
public:
  CudaAccelerator(Device device, Precision precision) : Where(std::move(device)), Kind(precision) {}
  ~CudaAccelerator() override;

  std::string name() const override
  {
    return std::string("CUDA ") + (this->Kind == Precision::Half ? "half" : "float32") + ", " +
           this->Where.name;
  }

  std::shared_ptr<const Evaluator> makeEvaluator(const ModelPointer& model) const override
  {
    return MakeEvaluator(this->uploaded(model).copy);
  }

  std::shared_ptr<const BrickSource> makeBrickSource(const ModelPointer& model,
                                                     const Hierarchy& hierarchy) const override
  {
    return MakeBrickSource(this->uploaded(model).copy, hierarchy);
  }

  std::shared_ptr<AcceleratedRenderer> makeRenderer(const ModelPointer& model,
                                                    const glm::i64vec3& dims,
                                                    const CacheOptions& options) const override
  {
    const Uploaded uploaded = this->uploaded(model);
    return MakeRenderer(uploaded.copy, *uploaded.stores, dims, options);
  }

  std::shared_ptr<AcceleratedRenderer> makeNetworkRenderer(const ModelPointer& model) const override
  {
    return MakeNetworkRenderer(this->uploaded(model).copy);
  }

private:
  struct Uploaded
  {
    std::shared_ptr<const DeviceModel> copy;
    std::shared_ptr<DeviceStores> stores;
  };
  /// As long as there is the copy.
  struct Known
  {
    std::weak_ptr<const Model> model;
    std::weak_ptr<const DeviceModel> copy;
    std::shared_ptr<DeviceStores> stores; ///< which know of caches, but keep none
  };

  /// The same for all that is made of a model.
  Uploaded uploaded(const ModelPointer& model) const
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto isGone = [](const Known& entry) { return entry.copy.expired(); };
    this->Entries.erase(std::remove_if(this->Entries.begin(), this->Entries.end(), isGone),
                        this->Entries.end());
    for (const Known& entry : this->Entries) {
      std::shared_ptr<const DeviceModel> copy = entry.copy.lock();
      if (copy && entry.model.lock() == model) {
        return {copy, entry.stores};
      }
    }
    Uploaded made{UploadModel(model, this->Where, this->Kind), MakeStores()};
    this->Entries.push_back({model, made.copy, made.stores});
    return made;
  }

  Device Where;
  Precision Kind;
  mutable std::mutex Mutex; ///< guards what follows
  mutable std::vector<Known> Entries;
};

// The process may end, or this library go, with or without somebody holding one.
static_assert(std::is_trivially_destructible_v<std::mutex>);
std::mutex SharedMutex;
constexpr int MostDevices = 64;
const CudaAccelerator* Shared[MostDevices] = {}; ///< by ordinal

CudaAccelerator::~CudaAccelerator()
{
  const std::lock_guard<std::mutex> lock(SharedMutex);
  std::replace(std::begin(Shared), std::end(Shared), static_cast<const CudaAccelerator*>(this),
               static_cast<const CudaAccelerator*>(nullptr));
}

std::shared_ptr<const Accelerator> SharedAccelerator(const Device& device)
{
  if (device.ordinal >= MostDevices) {
    return MakeAccelerator(device);
  }
  std::shared_ptr<const Accelerator> accelerator; // whose destructor takes the mutex, too
  const std::lock_guard<std::mutex> lock(SharedMutex);
  const CudaAccelerator*& shared = Shared[device.ordinal];
  accelerator = shared != nullptr ? shared->weak_from_this().lock() : nullptr;
  if (!accelerator || accelerator->hasFailed()) { // or one that is waiting to say that it goes
    auto made = std::make_shared<CudaAccelerator>(device, Precision::Float32);
    shared = made.get();
    return made;
  }
  return accelerator;
}

} // namespace

std::shared_ptr<const Accelerator> MakeAccelerator(const Device& device, Precision precision)
{
  return std::make_shared<CudaAccelerator>(device, precision);
}

FoundAccelerator FindAccelerator(int localRank)
{
  const Devices devices = FindDevices();
  const Device* const device = devices.of(localRank);
  return device != nullptr ? FoundAccelerator{SharedAccelerator(*device), ""}
                           : FoundAccelerator{nullptr, devices.reason};
}

} // namespace cuda
} // namespace inr
