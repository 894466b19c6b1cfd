// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/Kernels/BrickKernels.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

using namespace inr::cuda;

template <int Tiles> using HalfPoints = FusedPoints<Tiles, HalfNumbers>;
template <int Tiles> using HalfBricks = FusedBricks<Tiles, HalfNumbers>;
template <int Tiles> using WidePoints = FusedPoints<Tiles, FloatNumbers>;
template <int Tiles> using WideBricks = FusedBricks<Tiles, FloatNumbers>;

#define INR_INSTANTIATE_FOR_TILES(Kernel)                                                          \
  INR_INSTANTIATE(Kernel<1>);                                                                      \
  INR_INSTANTIATE(Kernel<2>);                                                                      \
  INR_INSTANTIATE(Kernel<4>);                                                                      \
  INR_INSTANTIATE(Kernel<8>)

INR_INSTANTIATE(FloatPoints);
INR_INSTANTIATE(FloatBricks);
INR_INSTANTIATE_FOR_TILES(HalfPoints);
INR_INSTANTIATE_FOR_TILES(HalfBricks);
INR_INSTANTIATE_FOR_TILES(WidePoints);
INR_INSTANTIATE_FOR_TILES(WideBricks);
