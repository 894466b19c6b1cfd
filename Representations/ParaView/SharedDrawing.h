// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

class vtkMultiProcessController;
class vtkRenderer;
class vtkVolume;

namespace inr {

/// Has all processes of a parallel server draw what `renderer` shows, whether that is in their
/// pictures or not: where they wait for each other, none may stay away. Call before each picture.
void DrawEverywhere(vtkRenderer* renderer);

/// Which of the processes whose pictures are being composed in order of depth is the one whose lies
/// over the others; negative where none are, or not as one picture. They need not ask each other.
int FrontProcess(vtkRenderer* renderer);

/// The INR volumes that `renderer` shows, in the same order in all processes.
std::vector<vtkVolume*> ShownVolumes(vtkRenderer* renderer);

/// Whether each of the processes has something to draw. All of them must ask, outside of drawing:
/// there one without anything does not know its turn among several volumes.
bool AllHave(vtkMultiProcessController* processes, bool something);

} // namespace inr
