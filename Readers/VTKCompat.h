// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkVersionMacros.h>

// Every difference between the VTK versions that we build against: 9.1 (plain, Debian 12) and
// 9.2.20230111 (in ParaView 5.11).

/// Range computations take a ghost array too.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
#define INR_VTK_GHOST_RANGES
#endif

/// Whether somebody wants the algorithm to stop. An executive's abort reaches it through CheckAbort
/// where there is such.
inline bool IsAborted(vtkAlgorithm& algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  return algorithm.CheckAbort() || algorithm.GetAbortExecute() != 0;
#else
  return algorithm.GetAbortExecute() != 0;
#endif
}
