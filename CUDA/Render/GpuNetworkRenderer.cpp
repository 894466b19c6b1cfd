// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/DevicePoints.h"
#include "CUDA/Render/NetworkRenderer.h"
#include "CUDA/Render/Renderers.h"

namespace inr {
namespace cuda {

template class NetworkRenderer<GpuMachine, DevicePoints>;

std::shared_ptr<AcceleratedRenderer>
MakeNetworkRenderer(const std::shared_ptr<const DeviceModel>& model)
{
  return std::make_shared<NetworkRenderer<GpuMachine, DevicePoints>>(model->device().ordinal,
                                                                     DevicePoints(model));
}

} // namespace cuda
} // namespace inr
