// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/LaunchDefinition.cuh"
#include "CUDA/Render/Kernels/LayeredMarch.h"
#include "CUDA/Render/Kernels/MarchKernels.h"
#include "CUDA/Render/Kernels/PathKernels.h"

namespace inr {
namespace cuda {

INR_INSTANTIATE(MarchBothEnds);
INR_INSTANTIATE(MarchLayeredRays);
INR_INSTANTIATE(MarchRays);
INR_INSTANTIATE(TracePaths);

} // namespace cuda
} // namespace inr
