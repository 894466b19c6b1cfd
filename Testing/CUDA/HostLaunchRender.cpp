// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Render/Kernels/LayeredMarch.h"
#include "CUDA/Render/Kernels/MarchKernels.h"
#include "CUDA/Render/Kernels/PathKernels.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

using namespace inr::cuda;

INR_INSTANTIATE(MarchBothEnds);
INR_INSTANTIATE(MarchLayeredRays);
INR_INSTANTIATE(MarchRays);
INR_INSTANTIATE(TracePaths);
