// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkMultiProcessController;

namespace inr {

/// Threads for this process if it shares its cores evenly with those of `controller` (which may be
/// null) that may run on the same ones: the ranks of a node that are not bound to cores of their
/// own. At least 1. All processes of `controller` must call it together.
int ThreadShare(vtkMultiProcessController* controller);

/// Which of `controller`'s processes on this machine this one is, from 0 on. All must call it
/// together, too.
int LocalRank(vtkMultiProcessController* controller);

/// How many they are. All must call it together, too.
int LocalProcesses(vtkMultiProcessController* controller);

} // namespace inr
