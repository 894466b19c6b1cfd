// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Render/Kernels/MarchWave.h"
#include "CUDA/Render/Kernels/PathWave.h"
#include "Testing/CUDA/HostLaunchDefinition.h"

using namespace inr::cuda;

INR_INSTANTIATE(AdvanceWave<MarchStages>);
INR_INSTANTIATE(ListNeighbors<MarchStages>);
INR_INSTANTIATE(AdvanceWave<PathStages>);
