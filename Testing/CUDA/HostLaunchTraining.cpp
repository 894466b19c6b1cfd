// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Training/Kernels/LaunchedTraining.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

INR_TRAINING_KERNELS(INR_INSTANTIATE);
