// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels that are launched, for an Each(Kernel) that instantiates one: by nvcc, and for the
// tests, which run them on the host.
#pragma once

#include "CUDA/Cache/Kernels/CacheTables.h"
#include "CUDA/Cache/Kernels/StoreBricks.h"

#define INR_CACHE_KERNELS(Each)                                                                    \
  Each(inr::cuda::ClearRequests);                                                                  \
  Each(inr::cuda::SelectFirst<inr::cuda::WantedBricks>);                                           \
  Each(inr::cuda::SelectFirst<inr::cuda::ReplaceableSlots>);                                       \
  Each(inr::cuda::SelectFirst<inr::cuda::SelectedEntries>);                                        \
  Each(inr::cuda::ListBricks);                                                                     \
  Each(inr::cuda::StoreBricks);                                                                    \
  Each(inr::cuda::MapSlots)
