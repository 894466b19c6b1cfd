// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/DeviceModel.h"

#include "CUDA/Device/Launch.h"
#include "CUDA/Render/DeviceStores.h"

#include <algorithm>
#include <utility>

namespace inr {
namespace cuda {

namespace {

constexpr std::int64_t MostScratch = 16 << 20; // floats

template <class T>
Array<T> Uploaded(const T* from, std::int64_t count, int device, const Stream& stream)
{
  Array<T> array(device, Memory::Place::Device, count);
  CopyToDevice(array.data(), from, count, stream);
  return array;
}

template <class T> Array<T> Uploaded(const std::vector<T>& from, int device, const Stream& stream)
{
  return Uploaded(from.data(), static_cast<std::int64_t>(from.size()), device, stream);
}

std::int64_t WeightCount(const Model& model)
{
  return static_cast<std::int64_t>(Layout(model.description).gridOffset);
}

std::int64_t FeatureCountOf(const Model& model)
{
  return static_cast<std::int64_t>(model.parameters.size()) - WeightCount(model);
}

const float* FeaturesOf(const Model& model) { return model.parameters.data() + WeightCount(model); }

/// Beside which tables of levels and layers are nothing.
void RequireRoom(const Model& model, int device, Precision precision)
{
  const auto parameters = static_cast<std::int64_t>(model.parameters.size());
  const bool half = precision == Precision::Half;
  const auto size = static_cast<std::int64_t>(half ? sizeof(HalfBits) : sizeof(float));
  RequireFree(device, parameters * size, half ? "the model in half precision" : "the model");
}

} // namespace

DeviceModel::HalfCopy::HalfCopy(PackedModel&& model, int device, const Stream& stream)
    : packed(std::move(model)), levels(Uploaded(this->packed.levels, device, stream)),
      features(Uploaded(this->packed.features, device, stream)),
      weights(Uploaded(this->packed.weights, device, stream)),
      view(this->packed.view(this->levels.data(), this->features.data(), this->weights.data()))
{
  stream.wait();
  this->packed.features = {};
}

DeviceModel::FloatCopy::FloatCopy(const Model& model, int device, const Stream& stream)
    : weights(Uploaded(model.parameters.data(), WeightCount(model), device, stream)),
      features(Uploaded(FeaturesOf(model), FeatureCountOf(model), device, stream)),
      tables(model, this->weights.data(), this->features.data()),
      levels(Uploaded(this->tables.levels, device, stream)),
      layers(Uploaded(this->tables.layers, device, stream)),
      view(this->tables.view(this->levels.data(), this->layers.data()))
{
  stream.wait();
}

DeviceModel::DeviceModel(ModelPointer model, const Device& device, Precision precision)
    : Source(std::move(model)), Where(device), Stores(std::make_unique<DeviceStores>())
{
  const CurrentDevice current(device.ordinal);
  RequireRoom(*this->Source, device.ordinal, precision);
  const Stream stream(device.ordinal);
  if (precision == Precision::Half) {
    this->Half.emplace(PackedModel(*this->Source), device.ordinal, stream);
  } else {
    RequireValid(*this->Source);
    this->Float.emplace(*this->Source, device.ordinal, stream);
  }
}

DeviceModel::~DeviceModel() = default;

LaunchPlan DeviceModel::plan(bool bricks) const
{
  const CurrentDevice current(this->Where.ordinal);
  return this->Half ? this->planHalf(bricks) : this->planFloat(bricks);
}

LaunchPlan DeviceModel::planHalf(bool bricks) const
{
  // Two blocks per multiprocessor at least, where that does: one computes while the other waits.
  // The system takes 1 KiB of each.
  const std::int64_t roomy =
      std::min(this->Where.sharedPerBlock, this->Where.sharedPerMultiprocessor / 2 - (1 << 10));
  LaunchPlan plan{};
  plan.shared = PlanShared(this->Half->packed, bricks, roomy, this->Where.sharedPerBlock);
  plan.sharedBytes = plan.shared.latticeEnd;
  WithTiles(this->Half->packed.neuronTiles, [&](auto tiles) {
    constexpr int count = decltype(tiles)::value;
    plan.blocks = bricks ? PrepareKernel<FusedBricks<count>>(plan.sharedBytes)
                         : PrepareKernel<FusedPoints<count>>(plan.sharedBytes);
  });
  return plan;
}

LaunchPlan DeviceModel::planFloat(bool bricks) const
{
  LaunchPlan plan{};
  const std::int64_t perBlock = ThreadsPerBlock * ScratchPerThread(this->Float->view);
  plan.blocks = std::clamp<std::int64_t>(MostScratch / perBlock, 1,
                                         bricks ? PrepareKernel<FloatBricks>(0)
                                                : PrepareKernel<FloatPoints>(0));
  plan.scratch = plan.blocks * perBlock;
  return plan;
}

void DeviceModel::inferPoints(const LaunchPlan& plan, const float* positions, std::int64_t count,
                              float* values, float* scratch, const Stream& stream) const
{
  const CurrentDevice current(this->Where.ordinal);
  const std::int64_t blocks =
      std::min(plan.blocks, (count + ThreadsPerBlock - 1) / ThreadsPerBlock);
  if (this->Float) {
    const FloatPoints kernel{this->Float->view, positions, count, values, scratch};
    LaunchKernel(kernel, blocks, 0, stream.get());
    return;
  }
  WithTiles(this->Half->packed.neuronTiles, [&](auto tiles) {
    const FusedPoints<decltype(tiles)::value> kernel{this->Half->view, plan.shared, positions,
                                                     count, values};
    LaunchKernel(kernel, blocks, plan.sharedBytes, stream.get());
  });
}

void DeviceModel::inferPoints(const LaunchPlan& plan, const float* positions,
                              const std::uint64_t* end, float* values, float* scratch,
                              const Stream& stream) const
{
  const CurrentDevice current(this->Where.ordinal);
  if (this->Float) {
    const FloatPoints kernel{this->Float->view, positions, 0, values, scratch, end};
    LaunchKernel(kernel, plan.blocks, 0, stream.get());
    return;
  }
  WithTiles(this->Half->packed.neuronTiles, [&](auto tiles) {
    const FusedPoints<decltype(tiles)::value> kernel{this->Half->view, plan.shared, positions, 0,
                                                     values,           end};
    LaunchKernel(kernel, plan.blocks, plan.sharedBytes, stream.get());
  });
}

void DeviceModel::inferBricks(const LaunchPlan& plan, const BrickJob* jobs, std::int64_t count,
                              std::int64_t items, float* values, float* scratch,
                              const Stream& stream) const
{
  const CurrentDevice current(this->Where.ordinal);
  if (this->Float) {
    const FloatBricks kernel{this->Float->view, jobs, count, values, scratch};
    LaunchKernel(kernel, plan.blocks, 0, stream.get());
    return;
  }
  WithTiles(this->Half->packed.neuronTiles, [&](auto tiles) {
    const FusedBricks<decltype(tiles)::value> kernel{
        this->Half->view, plan.shared, jobs, count, items, values};
    LaunchKernel(kernel, std::min(plan.blocks, items), plan.sharedBytes, stream.get());
  });
}

void DeviceModel::inferBricks(const LaunchPlan& plan, const BrickJob* jobs, const BrickEnd* end,
                              float* values, float* scratch, const Stream& stream) const
{
  const CurrentDevice current(this->Where.ordinal);
  if (this->Float) {
    const FloatBricks kernel{this->Float->view, jobs, 0, values, scratch, end};
    LaunchKernel(kernel, plan.blocks, 0, stream.get());
    return;
  }
  WithTiles(this->Half->packed.neuronTiles, [&](auto tiles) {
    const FusedBricks<decltype(tiles)::value> kernel{this->Half->view, plan.shared, jobs, 0, 0,
                                                     values,           end};
    LaunchKernel(kernel, plan.blocks, plan.sharedBytes, stream.get());
  });
}

std::shared_ptr<const DeviceModel> UploadModel(ModelPointer model, const Device& device,
                                               Precision precision)
{
  return std::make_shared<const DeviceModel>(std::move(model), device, precision);
}

} // namespace cuda
} // namespace inr
