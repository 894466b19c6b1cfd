// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels that are launched, for an Each(Kernel) that instantiates one: by nvcc, and for the
// tests, which run them on the host.
#pragma once

#include "CUDA/Training/Kernels/TrainDraw.h"
#include "CUDA/Training/Kernels/TrainLayers.h"
#include "CUDA/Training/Kernels/TrainNetwork.h"
#include "CUDA/Training/Kernels/TrainUpdate.h"

#define INR_TRAINING_KERNELS(Each)                                                                 \
  Each(inr::cuda::TrainDraw);                                                                      \
  Each(inr::cuda::TrainEncode);                                                                    \
  Each(inr::cuda::TrainNetwork);                                                                   \
  Each(inr::cuda::TrainWeights);                                                                   \
  Each(inr::cuda::TrainScatter);                                                                   \
  Each(inr::cuda::TrainSumShards);                                                                 \
  Each(inr::cuda::TrainUpdateLayers);                                                              \
  Each(inr::cuda::TrainUpdateWeights);                                                             \
  Each(inr::cuda::TrainUpdateGrid)
