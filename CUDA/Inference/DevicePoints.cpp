// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/DevicePoints.h"

#include "CUDA/Engine.h"

#include <algorithm>
#include <utility>

namespace inr {
namespace cuda {

template class NetworkRenderer<GpuMachine, DevicePoints>;

DevicePoints::DevicePoints(std::shared_ptr<const DeviceModel> model)
    : Uploaded(std::move(model)), Plan(this->Uploaded->plan(false)),
      Scratch(this->Uploaded->device().ordinal, Memory::Place::Device,
              std::max<std::int64_t>(this->Plan.scratch, 1))
{}

void DevicePoints::infer(GpuMachine& machine, const float* positions, const std::uint64_t* count,
                         float* values) const
{
  this->Uploaded->inferPoints(this->Plan, positions, count, values, this->Scratch.data(),
                              machine.stream());
}

std::shared_ptr<AcceleratedRenderer>
MakeNetworkRenderer(const std::shared_ptr<const DeviceModel>& model)
{
  return std::make_shared<NetworkRenderer<GpuMachine, DevicePoints>>(model->device().ordinal,
                                                                     DevicePoints(model));
}

} // namespace cuda
} // namespace inr
