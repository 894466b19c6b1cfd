// SPDX-License-Identifier: BSD-3-Clause
#include "SelectionPass.h"

#include "FrameBuilder.h"
#include "ImageBlender.h"
#include "PickedCells.h"

#include <vtkDataObject.h>
#include <vtkHardwareSelector.h>
#include <vtkRenderer.h>

#include <glm/vec3.hpp>

namespace inr {

bool MayBeSelected(vtkRenderer* renderer)
{
  return renderer->GetSelector()->GetFieldAssociation() != vtkDataObject::FIELD_ASSOCIATION_POINTS;
}

void MarkForSelection(vtkRenderer* renderer, const Image& rgba, const PickedCells& cells,
                      ImageBlender& blender)
{
  vtkHardwareSelector* selector = renderer->GetSelector();
  const Viewport viewport = GetViewport(renderer);
  switch (selector->GetCurrentPass()) {
  case vtkHardwareSelector::ACTOR_PASS: {
    glm::vec3 color;
    selector->GetPropColorValue(&color.x);
    selector->UpdateMaximumCellId(cells.last());
    blender.mark(renderer, viewport, PaintedWith(color, rgba));
    break;
  }
  case vtkHardwareSelector::CELL_ID_LOW24:
    blender.mark(renderer, viewport, cells.numbers(0));
    break;
  case vtkHardwareSelector::CELL_ID_HIGH24:
    blender.mark(renderer, viewport, cells.numbers(24));
    break;
  default:
    break;
  }
}

} // namespace inr
