// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/LaunchDefinition.cuh"
#include "CUDA/Inference/Kernels/LaunchedInference.h"

INR_FUSED_KERNELS(INR_INSTANTIATE, 4);
