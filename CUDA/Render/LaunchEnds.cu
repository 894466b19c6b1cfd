// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/LaunchDefinition.cuh"
#include "CUDA/Render/Kernels/LaunchedRender.h"

INR_ENDS_KERNELS(INR_INSTANTIATE);
