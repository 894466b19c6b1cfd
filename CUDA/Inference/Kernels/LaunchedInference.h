// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels that are launched, for an Each(Kernel) that instantiates one: by nvcc, and for the
// tests, which run them on the host. For nvcc each list, and that of each number of tiles, is a
// module of its own, for the reason that LaunchedRender.h gives: a model needs one of them.
#pragma once

#include "CUDA/Inference/Kernels/BrickKernels.h"

namespace inr {
namespace cuda {

template <int Tiles> using HalfPoints = FusedPoints<Tiles, HalfNumbers>;
template <int Tiles> using HalfBricks = FusedBricks<Tiles, HalfNumbers>;
template <int Tiles> using WidePoints = FusedPoints<Tiles, FloatNumbers>;
template <int Tiles> using WideBricks = FusedBricks<Tiles, FloatNumbers>;

} // namespace cuda
} // namespace inr

#define INR_PLAIN_KERNELS(Each)                                                                    \
  Each(inr::cuda::FloatPoints);                                                                    \
  Each(inr::cuda::FloatBricks)

#define INR_FUSED_KERNELS(Each, Tiles)                                                             \
  Each(inr::cuda::HalfPoints<Tiles>);                                                              \
  Each(inr::cuda::HalfBricks<Tiles>);                                                              \
  Each(inr::cuda::WidePoints<Tiles>);                                                              \
  Each(inr::cuda::WideBricks<Tiles>)
