// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Render/Kernels/MarchKernels.h"
#include "CUDA/Render/Kernels/PathKernels.h"
#include "CUDA/Device/LaunchDefinition.cuh"

namespace inr {
namespace cuda {

INR_INSTANTIATE(MarchRays);
INR_INSTANTIATE(TracePaths);

} // namespace cuda
} // namespace inr
