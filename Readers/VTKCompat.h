// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkVersionMacros.h>

// Every difference between the VTK versions that we build against: 9.1 (plain, Debian 12) and
// 9.2.20230111 (in ParaView 5.11).

/// Range computations take a ghost array too.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
#define INR_VTK_GHOST_RANGES
#endif

/// An executive's abort reaches an algorithm through vtkAlgorithm::CheckAbort.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
#define INR_VTK_CHECK_ABORT
#endif
