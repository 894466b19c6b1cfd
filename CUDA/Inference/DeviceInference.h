// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Machine.h"
#include "CUDA/Inference/PlannedModel.h"

#include <memory>
#include <utility>

namespace inr {
namespace cuda {

/// A model in a GPU's memory, for a DeviceCache: infers bricks from one place there to another.
class DeviceInference : public PlannedModel
{
public:
  /// `bytes`: see PlannedModel.
  DeviceInference(std::shared_ptr<const DeviceModel> model, std::int64_t bytes)
      : PlannedModel(std::move(model), true, bytes)
  {}

  /// Begins with as many jobs as `end` says once the machine has come to it. `values`: normalised.
  /// A value that does not fit the kernel's numbers becomes NaN.
  void infer(GpuMachine& machine, const BrickJob* jobs, const BrickEnd* end, float* values) const
  {
    this->Uploaded->inferBricks(this->Plan, jobs, end, values, this->Scratch.data(),
                                machine.stream());
  }
};

} // namespace cuda
} // namespace inr
