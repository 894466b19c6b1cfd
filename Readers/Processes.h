// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkMultiProcessController.h>

/// Whether a group, which may be null, is of more than this process.
inline bool AreSeveral(vtkMultiProcessController* processes)
{
  return processes && processes->GetNumberOfProcesses() > 1;
}
