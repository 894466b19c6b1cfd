// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels that are launched, for an Each(Kernel) that instantiates one: by nvcc, and for the
// tests, which run them on the host.
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

#define INR_INFERENCE_KERNELS(Each)                                                                \
  Each(inr::cuda::FloatPoints);                                                                    \
  Each(inr::cuda::FloatBricks);                                                                    \
  Each(inr::cuda::HalfPoints<1>);                                                                  \
  Each(inr::cuda::HalfPoints<2>);                                                                  \
  Each(inr::cuda::HalfPoints<4>);                                                                  \
  Each(inr::cuda::HalfPoints<8>);                                                                  \
  Each(inr::cuda::HalfBricks<1>);                                                                  \
  Each(inr::cuda::HalfBricks<2>);                                                                  \
  Each(inr::cuda::HalfBricks<4>);                                                                  \
  Each(inr::cuda::HalfBricks<8>);                                                                  \
  Each(inr::cuda::WidePoints<1>);                                                                  \
  Each(inr::cuda::WidePoints<2>);                                                                  \
  Each(inr::cuda::WidePoints<4>);                                                                  \
  Each(inr::cuda::WidePoints<8>);                                                                  \
  Each(inr::cuda::WideBricks<1>);                                                                  \
  Each(inr::cuda::WideBricks<2>);                                                                  \
  Each(inr::cuda::WideBricks<4>);                                                                  \
  Each(inr::cuda::WideBricks<8>)
