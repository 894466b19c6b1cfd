// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/DeviceModel.h"

#include "CUDA/Device/Launch.h"

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
void RequireRoom(const Model& model, int device, bool half)
{
  const auto parameters = static_cast<std::int64_t>(model.parameters.size());
  const auto size = static_cast<std::int64_t>(half ? sizeof(HalfBits) : sizeof(float));
  RequireFree(device, parameters * size, half ? "the model in half precision" : "the model");
}

/// Float32's need no packing.
Array<HalfBits> UploadedFeatures(const PackedModel<HalfNumbers>& packed, const Model& /*model*/,
                                 int device, const Stream& stream)
{
  return Uploaded(packed.features, device, stream);
}
Array<float> UploadedFeatures(const PackedModel<FloatNumbers>& /*packed*/, const Model& model,
                              int device, const Stream& stream)
{
  return Uploaded(FeaturesOf(model), FeatureCountOf(model), device, stream);
}

/// Whether products of parts of float32 numbers are to be had: by the code, as what the driver
/// translates for a later GPU has them no more than the one that it was made for.
bool HasWideTiles(const Device& device)
{
  constexpr int first = 80; // compute capability 8.0
  return device.code >= first;
}

} // namespace

template <class Numbers>
DeviceModel::FusedCopy<Numbers>::FusedCopy(PackedModel<Numbers>&& from, const Model& model,
                                           int device, const Stream& stream)
    : packed(std::move(from)), levels(Uploaded(this->packed.levels, device, stream)),
      features(UploadedFeatures(this->packed, model, device, stream)),
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
    : Source(std::move(model)), Where(device)
{
  const CurrentDevice current(device.ordinal);
  const bool half = precision == Precision::Half;
  RequireRoom(*this->Source, device.ordinal, half);
  const Stream stream(device.ordinal);
  if (half) {
    this->Half.emplace(PackedModel<HalfNumbers>(*this->Source), *this->Source, device.ordinal,
                       stream);
    return;
  }
  if (precision == Precision::Float32 && HasWideTiles(device) &&
      WhyNotFused(*this->Source).empty()) {
    PackedModel<FloatNumbers> packed(*this->Source, false);
    if (FitsShared(packed, device.sharedPerBlock)) {
      this->Wide.emplace(std::move(packed), *this->Source, device.ordinal, stream);
      return;
    }
  }
  CheckedLayout(*this->Source); // throws where it is not valid
  this->Plain.emplace(*this->Source, device.ordinal, stream);
}

LaunchPlan DeviceModel::plan(bool bricks) const
{
  const CurrentDevice current(this->Where.ordinal);
  if (this->Plain) {
    return this->planPlain(bricks);
  }
  return this->Half ? this->planFused(*this->Half, bricks) : this->planFused(*this->Wide, bricks);
}

template <class Numbers>
LaunchPlan DeviceModel::planFused(const FusedCopy<Numbers>& copy, bool bricks) const
{
  // Two blocks per multiprocessor at least, where that does: one computes while the other waits.
  // The system takes 1 KiB of each.
  const std::int64_t roomy =
      std::min(this->Where.sharedPerBlock, this->Where.sharedPerMultiprocessor / 2 - (1 << 10));
  LaunchPlan plan{};
  plan.shared = PlanShared(copy.packed, bricks, roomy, this->Where.sharedPerBlock);
  plan.sharedBytes = plan.shared.end;
  WithTiles(copy.packed.neuronTiles, [&](auto tiles) {
    constexpr int count = decltype(tiles)::value;
    plan.blocks = bricks ? PrepareKernel<FusedBricks<count, Numbers>>(plan.sharedBytes)
                         : PrepareKernel<FusedPoints<count, Numbers>>(plan.sharedBytes);
  });
  return plan;
}

LaunchPlan DeviceModel::planPlain(bool bricks) const
{
  LaunchPlan plan{};
  const std::int64_t perBlock = ThreadsPerBlock * ScratchPerThread(this->Plain->view);
  plan.blocks = std::clamp<std::int64_t>(MostScratch / perBlock, 1,
                                         bricks ? PrepareKernel<FloatBricks>(0)
                                                : PrepareKernel<FloatPoints>(0));
  plan.scratch = plan.blocks * perBlock;
  return plan;
}

template <class Numbers>
void DeviceModel::beginFused(const FusedCopy<Numbers>& copy, const LaunchPlan& plan,
                             const PointRun& run, std::int64_t blocks, const Stream& stream) const
{
  WithTiles(copy.packed.neuronTiles, [&](auto tiles) {
    const FusedPoints<decltype(tiles)::value, Numbers> kernel{copy.view, plan.shared, run.positions,
                                                              run.count, run.values,  run.end};
    LaunchKernel(kernel, blocks, plan.sharedBytes, stream.get());
  });
}

template <class Numbers>
void DeviceModel::beginFused(const FusedCopy<Numbers>& copy, const LaunchPlan& plan,
                             const BrickLaunch& run, std::int64_t blocks,
                             const Stream& stream) const
{
  WithTiles(copy.packed.neuronTiles, [&](auto tiles) {
    const FusedBricks<decltype(tiles)::value, Numbers> kernel{
        copy.view, plan.shared, run.jobs, run.count, run.items, run.values, run.end};
    LaunchKernel(kernel, blocks, plan.sharedBytes, stream.get());
  });
}

void DeviceModel::begin(const LaunchPlan& plan, const PointRun& run, std::int64_t blocks,
                        float* scratch, const Stream& stream) const
{
  const CurrentDevice current(this->Where.ordinal);
  if (this->Plain) {
    const FloatPoints kernel{this->Plain->view, run.positions, run.count,
                             run.values,        scratch,       run.end};
    LaunchKernel(kernel, blocks, 0, stream.get());
  } else if (this->Half) {
    this->beginFused(*this->Half, plan, run, blocks, stream);
  } else {
    this->beginFused(*this->Wide, plan, run, blocks, stream);
  }
}

void DeviceModel::begin(const LaunchPlan& plan, const BrickLaunch& run, std::int64_t blocks,
                        float* scratch, const Stream& stream) const
{
  const CurrentDevice current(this->Where.ordinal);
  if (this->Plain) {
    const FloatBricks kernel{this->Plain->view, run.jobs, run.count, run.values, scratch, run.end};
    LaunchKernel(kernel, plan.blocks, 0, stream.get());
  } else if (this->Half) {
    this->beginFused(*this->Half, plan, run, blocks, stream);
  } else {
    this->beginFused(*this->Wide, plan, run, blocks, stream);
  }
}

void DeviceModel::inferPoints(const LaunchPlan& plan, const float* positions, std::int64_t count,
                              float* values, float* scratch, const Stream& stream) const
{
  const std::int64_t blocks =
      std::min(plan.blocks, (count + ThreadsPerBlock - 1) / ThreadsPerBlock);
  this->begin(plan, PointRun{positions, count, nullptr, values}, blocks, scratch, stream);
}

void DeviceModel::inferPoints(const LaunchPlan& plan, const float* positions,
                              const std::uint64_t* end, float* values, float* scratch,
                              const Stream& stream) const
{
  this->begin(plan, PointRun{positions, 0, end, values}, plan.blocks, scratch, stream);
}

void DeviceModel::inferBricks(const LaunchPlan& plan, const BrickJob* jobs, std::int64_t count,
                              std::int64_t items, float* values, float* scratch,
                              const Stream& stream) const
{
  this->begin(plan, BrickLaunch{jobs, count, items, nullptr, values}, std::min(plan.blocks, items),
              scratch, stream);
}

void DeviceModel::inferBricks(const LaunchPlan& plan, const BrickJob* jobs, const BrickEnd* end,
                              float* values, float* scratch, const Stream& stream) const
{
  this->begin(plan, BrickLaunch{jobs, 0, 0, end, values}, plan.blocks, scratch, stream);
}

std::shared_ptr<const DeviceModel> UploadModel(ModelPointer model, const Device& device,
                                               Precision precision)
{
  return std::make_shared<const DeviceModel>(std::move(model), device, precision);
}

} // namespace cuda
} // namespace inr
