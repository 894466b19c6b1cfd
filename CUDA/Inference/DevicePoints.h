// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Machine.h"
#include "CUDA/Inference/PlannedModel.h"

#include <memory>
#include <utility>

namespace inr {
namespace cuda {

/// A model in a GPU's memory, for a DeviceWave: infers points from one place there to another.
class DevicePoints : public PlannedModel
{
public:
  explicit DevicePoints(std::shared_ptr<const DeviceModel> model)
      : PlannedModel(std::move(model), false, NoLimit)
  {}

  /// See DeviceWave.
  void infer(GpuMachine& machine, const float* positions, const std::uint64_t* count,
             float* values) const
  {
    this->Uploaded->inferPoints(this->Plan, positions, count, values, this->Scratch.data(),
                                machine.stream());
  }
};

} // namespace cuda
} // namespace inr
