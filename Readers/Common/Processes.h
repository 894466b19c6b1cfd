// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"

#include <vtkMultiProcessController.h>

/// Whether a group, which may be null, is of more than this process.
inline bool AreSeveral(vtkMultiProcessController* processes)
{
  return processes && processes->GetNumberOfProcesses() > 1;
}

/// Of what a controller's collective call returns, which is 0 where it failed. Throws
/// Error(CannotRead).
inline void RequireReached(int result)
{
  if (result == 0) {
    throw inr::Error(inr::ErrorCode::CannotRead, "the other processes cannot be reached");
  }
}
