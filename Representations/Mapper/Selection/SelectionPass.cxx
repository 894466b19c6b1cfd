// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Selection/SelectionPass.h"

#include "Readers/Common/Processes.h"
#include "Representations/Mapper/Scene/Viewport.h"
#include "Representations/Mapper/Selection/PickedCells.h"
#include "Representations/Mapper/Window/ImageBlender.h"

#include <vtkDataObject.h>
#include <vtkHardwareSelector.h>
#include <vtkMultiProcessController.h>
#include <vtkRenderer.h>

#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

namespace {

/// Of this process among those that have pieces, whose cells have the same numbers: from 1 on, as
/// vtkHardwareSelector has them; 0 where there is only one.
int NumberOfProcess()
{
  auto* controller = vtkMultiProcessController::GetGlobalController();
  return AreSeveral(controller) ? controller->GetLocalProcessId() + 1 : 0;
}

} // namespace

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
  case vtkHardwareSelector::COMPOSITE_INDEX_PASS: // 0, instead of that of a surface behind
    blender.mark(renderer, viewport, PaintedWith(ColorOfBits(0), rgba));
    break;
  case vtkHardwareSelector::PROCESS_PASS: {
    const auto bits = static_cast<std::uint64_t>(NumberOfProcess());
    blender.mark(renderer, viewport, PaintedWith(ColorOfBits(bits), rgba));
    break;
  }
  default:
    break;
  }
}

} // namespace inr
