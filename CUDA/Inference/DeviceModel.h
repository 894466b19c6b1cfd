// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Runtime.h"
#include "CUDA/Engine.h"
#include "CUDA/Inference/Kernels/BrickKernels.h"
#include "CUDA/Inference/PackedModel.h"

#include <optional>

namespace inr {
namespace cuda {

/// How a model's kernel is begun.
struct LaunchPlan
{
  FusedShared shared; ///< of fused kernels
  std::int64_t sharedBytes;
  std::int64_t blocks;  ///< that are in work at once
  std::int64_t scratch; ///< floats that float32 kernels want, for all of these blocks
};

class DeviceStores;

class DeviceModel
{
public:
  DeviceModel(ModelPointer model, const Device& device, Precision precision);
  ~DeviceModel();

  /// What its renderers share.
  DeviceStores& stores() const { return *this->Stores; }

  const ModelPointer& source() const { return this->Source; }
  const Device& device() const { return this->Where; }
  Precision precision() const { return this->Half ? Precision::Half : Precision::Float32; }
  const char* name() const { return this->Half ? "cuda half" : "cuda float32"; }

  /// For the kernel at points, or the one at bricks.
  LaunchPlan plan(bool bricks) const;

  /// Begin kernels behind what is in the stream; all addresses are the device's. `scratch`: as the
  /// plan says.
  void inferPoints(const LaunchPlan& plan, const float* positions, std::int64_t count,
                   float* values, float* scratch, const Stream& stream) const;
  /// The same of as many as are found at `end` by then.
  void inferPoints(const LaunchPlan& plan, const float* positions, const std::uint64_t* end,
                   float* values, float* scratch, const Stream& stream) const;
  void inferBricks(const LaunchPlan& plan, const BrickJob* jobs, std::int64_t count,
                   std::int64_t items, float* values, float* scratch, const Stream& stream) const;
  /// The same of as many as are found at `end` by then.
  void inferBricks(const LaunchPlan& plan, const BrickJob* jobs, const BrickEnd* end, float* values,
                   float* scratch, const Stream& stream) const;

private:
  struct HalfCopy
  {
    /// `stream` has copied everything when `packed` loses its tables.
    HalfCopy(PackedModel&& model, int device, const Stream& stream);

    PackedModel packed; ///< its features are on the device only
    Array<LevelView> levels;
    Array<HalfBits> features;
    Array<WeightShare> weights;
    FusedModel view;
  };
  struct FloatCopy
  {
    FloatCopy(const Model& model, int device, const Stream& stream);

    Array<float> weights;
    Array<float> features;
    FloatTables tables;
    Array<LevelView> levels;
    Array<LayerView> layers;
    FloatModel view;
  };

  LaunchPlan planHalf(bool bricks) const;
  LaunchPlan planFloat(bool bricks) const;

  ModelPointer Source;
  Device Where;
  std::optional<HalfCopy> Half; ///< one of the two
  std::optional<FloatCopy> Float;
  std::unique_ptr<DeviceStores> Stores;
};

} // namespace cuda
} // namespace inr
