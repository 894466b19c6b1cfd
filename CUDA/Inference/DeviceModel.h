// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Runtime.h"
#include "CUDA/Inference/Kernels/BrickKernels.h"
#include "CUDA/Inference/PackedModel.h"
#include "CUDA/Inference/UploadedModel.h"

#include <optional>

namespace inr {
namespace cuda {

/// How a model's kernel is begun.
struct LaunchPlan
{
  FusedShared shared; ///< of fused kernels
  std::int64_t sharedBytes;
  std::int64_t blocks;  ///< that are in work at once
  std::int64_t scratch; ///< floats that plain kernels want, for all of these blocks
};

class DeviceModel
{
public:
  DeviceModel(ModelPointer model, const Device& device, Precision precision);

  const ModelPointer& source() const { return this->Source; }
  const Device& device() const { return this->Where; }
  const char* name() const
  {
    return this->Half ? "cuda half" : (this->Wide ? "cuda float32" : "cuda plain float32");
  }

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
  /// What is to be inferred, and where to.
  struct PointRun
  {
    const float* positions;
    std::int64_t count;
    const std::uint64_t* end; ///< where not null, of so many instead
    float* values;
  };
  struct BrickLaunch
  {
    const BrickJob* jobs;
    std::int64_t count;
    std::int64_t items;
    const BrickEnd* end; ///< where not null, of so many instead
    float* values;
  };

  template <class Numbers> struct FusedCopy
  {
    /// `stream` has copied everything when `packed` loses its tables.
    FusedCopy(PackedModel<Numbers>&& from, const Model& model, int device, const Stream& stream);

    PackedModel<Numbers> packed; ///< its features are on the device only
    Array<LevelView> levels;
    Array<typename Numbers::Feature> features;
    Array<typename Numbers::Weight> weights;
    FusedModel<Numbers> view;
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

  template <class Numbers> LaunchPlan planFused(const FusedCopy<Numbers>& copy, bool bricks) const;
  LaunchPlan planPlain(bool bricks) const;
  void begin(const LaunchPlan& plan, const PointRun& run, std::int64_t blocks, float* scratch,
             const Stream& stream) const;
  void begin(const LaunchPlan& plan, const BrickLaunch& run, std::int64_t blocks, float* scratch,
             const Stream& stream) const;
  template <class Numbers>
  void beginFused(const FusedCopy<Numbers>& copy, const LaunchPlan& plan, const PointRun& run,
                  std::int64_t blocks, const Stream& stream) const;
  template <class Numbers>
  void beginFused(const FusedCopy<Numbers>& copy, const LaunchPlan& plan, const BrickLaunch& run,
                  std::int64_t blocks, const Stream& stream) const;

  ModelPointer Source;
  Device Where;
  std::optional<FusedCopy<HalfNumbers>> Half; ///< one of the three
  std::optional<FusedCopy<FloatNumbers>> Wide;
  std::optional<FloatCopy> Plain;
};

} // namespace cuda
} // namespace inr
