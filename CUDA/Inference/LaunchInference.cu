// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/Kernels/BrickKernels.h"
#include "CUDA/Device/LaunchDefinition.cuh"

namespace inr {
namespace cuda {

INR_INSTANTIATE(FloatPoints);
INR_INSTANTIATE(FloatBricks);
INR_INSTANTIATE(FusedPoints<1>);
INR_INSTANTIATE(FusedPoints<2>);
INR_INSTANTIATE(FusedPoints<4>);
INR_INSTANTIATE(FusedPoints<8>);
INR_INSTANTIATE(FusedBricks<1>);
INR_INSTANTIATE(FusedBricks<2>);
INR_INSTANTIATE(FusedBricks<4>);
INR_INSTANTIATE(FusedBricks<8>);

} // namespace cuda
} // namespace inr
