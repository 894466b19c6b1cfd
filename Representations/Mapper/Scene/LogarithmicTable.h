// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <vector>

class vtkColorTransferFunction;
class vtkPiecewiseFunction;

namespace inr {

/// What a function with a logarithmic scale, of positive nodes, says of a value, as a function with
/// a linear one that is asked for the value's common logarithm.
vtkSmartPointer<vtkColorTransferFunction> OverLogarithms(vtkColorTransferFunction* function);

/// A function's values at places that rise, at a cost of nodes plus places; its own GetValue would
/// walk along all nodes for every place.
std::vector<double> AtRising(vtkPiecewiseFunction* function, const std::vector<double>& places);

/// Where a function of either kind has its nodes, which rise.
template <typename Function> std::vector<double> NodesOf(Function* function)
{
  std::vector<double> places;
  for (int k = 0; k < function->GetSize(); ++k) {
    double node[6]; // the place and what is there: of a piecewise function three numbers, else five
    function->GetNodeValue(k, node);
    places.push_back(node[0]);
  }
  return places;
}

} // namespace inr
