// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/Kernels/LaunchedCache.h"
#include "Testing/CUDA/AskFor.h"
#include "Testing/CUDA/HostLaunchDefinition.h"
#include "Testing/CUDA/RuledInference.h"

INR_CACHE_KERNELS(INR_INSTANTIATE);
INR_INSTANTIATE(AskFor);
INR_INSTANTIATE(RuledBricks);
