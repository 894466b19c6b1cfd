// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/LaunchDefinition.cuh"
#include "CUDA/Training/Kernels/LaunchedTraining.h"

INR_TRAINING_KERNELS(INR_INSTANTIATE);
