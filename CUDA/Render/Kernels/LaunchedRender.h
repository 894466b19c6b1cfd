// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels that are launched, for an Each(Kernel) that instantiates one: by nvcc, and for the
// tests, which run them on the host.
#pragma once

#include "CUDA/Render/Kernels/LayeredMarch.h"
#include "CUDA/Render/Kernels/MarchKernels.h"
#include "CUDA/Render/Kernels/PathKernels.h"

#define INR_RENDER_KERNELS(Each)                                                                   \
  Each(inr::cuda::MarchBothEnds);                                                                  \
  Each(inr::cuda::MarchLayeredRays);                                                               \
  Each(inr::cuda::MarchRays);                                                                      \
  Each(inr::cuda::TracePaths)
