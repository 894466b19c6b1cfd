// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/Kernels/LaunchedCache.h"
#include "CUDA/Device/LaunchDefinition.cuh"

INR_CACHE_KERNELS(INR_INSTANTIATE);
