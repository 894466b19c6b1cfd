// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Render/Kernels/LaunchedRender.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

INR_RENDER_KERNELS(INR_INSTANTIATE);
INR_LAYERS_KERNELS(INR_INSTANTIATE);
INR_ENDS_KERNELS(INR_INSTANTIATE);
