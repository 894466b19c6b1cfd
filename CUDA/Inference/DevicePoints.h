// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Machine.h"
#include "CUDA/Inference/DeviceModel.h"
#include "CUDA/Render/NetworkRenderer.h"

#include <memory>

namespace inr {
namespace cuda {

/// A model in a GPU's memory, for a DeviceWave: infers points from one place there to another.
class DevicePoints
{
public:
  explicit DevicePoints(std::shared_ptr<const DeviceModel> model);

  const ModelPointer& source() const { return this->Uploaded->source(); }

  /// See DeviceWave.
  void infer(GpuMachine& machine, const float* positions, const std::uint64_t* count,
             float* values) const;

private:
  std::shared_ptr<const DeviceModel> Uploaded;
  LaunchPlan Plan;
  Array<float> Scratch;
};

extern template class NetworkRenderer<GpuMachine, DevicePoints>;

} // namespace cuda
} // namespace inr
