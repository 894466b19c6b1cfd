// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/DeviceCache.h"
#include "CUDA/Device/Machine.h"
#include "CUDA/Inference/DeviceModel.h"

#include <memory>

namespace inr {
namespace cuda {

/// A model in a GPU's memory, for a DeviceCache: infers bricks from one place there to another.
class DeviceInference
{
public:
  /// `bytes`: that its scratch may take; it takes what one block needs where that is more.
  DeviceInference(std::shared_ptr<const DeviceModel> model, std::int64_t bytes);

  const ModelPointer& source() const { return this->Uploaded->source(); }
  std::int64_t bytes() const; ///< beside the model

  /// Begins with as many jobs as `end` says once the machine has come to it. `values`: normalised.
  /// A value that does not fit the kernel's numbers becomes NaN.
  void infer(GpuMachine& machine, const BrickJob* jobs, const BrickEnd* end, float* values) const;

private:
  std::shared_ptr<const DeviceModel> Uploaded;
  LaunchPlan Plan;
  Array<float> Scratch;
};

extern template class DeviceCache<GpuMachine, DeviceInference>;

} // namespace cuda
} // namespace inr
