// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkPropCollection.h>
#include <vtkRenderer.h>

namespace inr {

/// Calls `function` with each vtkProp* that has been added to a renderer, in that order.
template <class Function> void ForEachProp(vtkRenderer* renderer, const Function& function)
{
  vtkCollectionSimpleIterator place; // so that somebody else may be going through them, too
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(place);
  while (vtkProp* prop = props->GetNextProp(place)) {
    function(prop);
  }
}

} // namespace inr
