// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/Kernels/CacheTables.h"
#include "CUDA/Cache/Kernels/StoreBricks.h"
#include "Testing/CUDA/AskFor.h"
#include "Testing/CUDA/HostLaunchDefinition.h"
#include "Testing/CUDA/RuledInference.h"

using namespace inr::cuda;

INR_INSTANTIATE(ClearRequests);
INR_INSTANTIATE(SelectFirst<WantedBricks>);
INR_INSTANTIATE(SelectFirst<ReplaceableSlots>);
INR_INSTANTIATE(SelectFirst<SelectedEntries>);
INR_INSTANTIATE(ListBricks);
INR_INSTANTIATE(StoreBricks);
INR_INSTANTIATE(MapSlots);
INR_INSTANTIATE(AskFor);
INR_INSTANTIATE(RuledBricks);
