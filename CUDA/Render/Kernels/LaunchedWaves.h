// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels that are launched, for an Each(Kernel) that instantiates one: by nvcc, and for the
// tests, which run them on the host.
#pragma once

#include "CUDA/Render/Kernels/MarchWave.h"
#include "CUDA/Render/Kernels/PathWave.h"

#define INR_WAVES_KERNELS(Each)                                                                    \
  Each(inr::cuda::AdvanceWave<inr::cuda::MarchStages>);                                            \
  Each(inr::cuda::ListNeighbors<inr::cuda::MarchStages>);                                          \
  Each(inr::cuda::AdvanceWave<inr::cuda::PathStages>)
