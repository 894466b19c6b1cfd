// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/LaunchDefinition.cuh"
#include "CUDA/Render/Kernels/LaunchedWaves.h"

INR_WAVES_KERNELS(INR_INSTANTIATE);
