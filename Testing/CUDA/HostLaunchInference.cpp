// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/Kernels/LaunchedInference.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

INR_INFERENCE_KERNELS(INR_INSTANTIATE);
