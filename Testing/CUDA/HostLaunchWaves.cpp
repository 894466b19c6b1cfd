// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Render/Kernels/LaunchedWaves.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

INR_WAVES_KERNELS(INR_INSTANTIATE);
