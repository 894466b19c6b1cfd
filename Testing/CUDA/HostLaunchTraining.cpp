// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Training/Kernels/TrainDraw.h"
#include "CUDA/Training/Kernels/TrainLayers.h"
#include "CUDA/Training/Kernels/TrainNetwork.h"
#include "CUDA/Training/Kernels/TrainUpdate.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

using namespace inr::cuda;

INR_INSTANTIATE(TrainDraw);
INR_INSTANTIATE(TrainEncode);
INR_INSTANTIATE(TrainNetwork);
INR_INSTANTIATE(TrainWeights);
INR_INSTANTIATE(TrainScatter);
INR_INSTANTIATE(TrainSumShards);
INR_INSTANTIATE(TrainUpdateLayers);
INR_INSTANTIATE(TrainUpdateWeights);
INR_INSTANTIATE(TrainUpdateGrid);
