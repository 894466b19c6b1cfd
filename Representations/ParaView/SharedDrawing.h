// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkRenderer;

namespace inr {

/// Has all processes of a parallel server draw what `renderer` shows, whether that is in their
/// pictures or not: where they wait for each other, none may stay away. Call before each picture.
void DrawEverywhere(vtkRenderer* renderer);

/// Which of the processes whose pictures are being composed in order of depth is the one whose lies
/// over the others; negative where none are, or not as one picture, or one of them has nothing to
/// draw. All must ask.
int FrontProcess(vtkRenderer* renderer, bool hasSomething);

} // namespace inr
