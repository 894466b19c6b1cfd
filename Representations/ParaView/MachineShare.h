// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkMultiProcessController;

namespace inr {

/// What one of several processes on a machine may take of it.
struct MachineShare
{
  /// Its share of the cores, among those processes that may run on the same ones: the ranks of a
  /// node that are not bound to cores of their own; 0 = as many as there are.
  int threads = 0;
  int rank = 0;      ///< among the processes on this machine, from 0 on
  int cacheSize = 0; ///< MiB, of the default cache; 0 = all of it, as the process is alone
};

/// Of this process, shared evenly with those of `controller`, which may be null and all of which
/// must call it together.
MachineShare ShareMachine(vtkMultiProcessController* controller);

} // namespace inr
