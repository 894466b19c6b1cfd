// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Kernels/MarchKernels.h"
#include "CUDA/Kernels/PathKernels.h"
#include "CUDA/LaunchDefinition.cuh"

namespace inr {
namespace cuda {

INR_INSTANTIATE(MarchRays);
INR_INSTANTIATE(TracePaths);

} // namespace cuda
} // namespace inr
