// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels that are launched, for an Each(Kernel) that instantiates one: by nvcc, and for the
// tests, which run them on the host. For nvcc each list is a module of its own: where there is no
// code for a GPU, its driver translates a whole module when a kernel of it is first launched, in
// the midst of a picture, which is not to wait for what only other pictures need.
#pragma once

#include "CUDA/Render/Kernels/LayeredMarch.h"
#include "CUDA/Render/Kernels/MarchKernels.h"
#include "CUDA/Render/Kernels/PathKernels.h"

#define INR_RENDER_KERNELS(Each)                                                                   \
  Each(inr::cuda::MarchRays);                                                                      \
  Each(inr::cuda::TracePaths)

#define INR_LAYERS_KERNELS(Each) Each(inr::cuda::MarchLayeredRays)

#define INR_ENDS_KERNELS(Each) Each(inr::cuda::MarchBothEnds)
