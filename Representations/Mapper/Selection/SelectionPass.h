// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkRenderer;

namespace inr {

class ImageBlender;
class PickedCells;
struct Image;

/// Whether the selector of `renderer` asks for anything that a volume has; nobody sees its points.
bool MayBeSelected(vtkRenderer* renderer);

/// Marks, for the pass that the selector is at, where `rgba` shows the volume, and which cells.
void MarkForSelection(vtkRenderer* renderer, const Image& rgba, const PickedCells& cells,
                      ImageBlender& blender);

} // namespace inr
