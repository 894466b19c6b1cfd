// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Kernels/TrainDraw.h"
#include "CUDA/Kernels/TrainNetwork.h"
#include "CUDA/Kernels/TrainUpdate.h"
#include "CUDA/LaunchDefinition.cuh"

namespace inr {
namespace cuda {

INR_INSTANTIATE(TrainDraw);
INR_INSTANTIATE(TrainEncode);
INR_INSTANTIATE(TrainNetwork);
INR_INSTANTIATE(TrainWeights);
INR_INSTANTIATE(TrainScatter);
INR_INSTANTIATE(TrainUpdateWeights);
INR_INSTANTIATE(TrainUpdateGrid);

} // namespace cuda
} // namespace inr
