// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/Kernels/CacheTables.h"
#include "CUDA/Cache/Kernels/StoreBricks.h"
#include "CUDA/Device/LaunchDefinition.cuh"

namespace inr {
namespace cuda {

INR_INSTANTIATE(ClearRequests);
INR_INSTANTIATE(SelectFirst<WantedBricks>);
INR_INSTANTIATE(SelectFirst<ReplaceableSlots>);
INR_INSTANTIATE(SelectFirst<SelectedEntries>);
INR_INSTANTIATE(ListBricks);
INR_INSTANTIATE(StoreBricks);
INR_INSTANTIATE(MapSlots);

} // namespace cuda
} // namespace inr
