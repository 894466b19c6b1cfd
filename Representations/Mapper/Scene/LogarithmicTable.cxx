// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/LogarithmicTable.h"

#include <vtkColorTransferFunction.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace inr {
namespace {

/// Some node of a function and the next one, as a function of their own.
class Stretch
{
public:
  explicit Stretch(vtkPiecewiseFunction* function) : All(function)
  {
    this->Two->SetUseLogScale(function->GetUseLogScale());
  }

  /// The values between node k and k + 1, which is not the last one.
  double at(int k, double place)
  {
    if (k != this->First) {
      this->Two->RemoveAllPoints();
      for (int node = k; node < k + 2; ++node) {
        double v[4]; // place, value, midpoint, sharpness
        this->All->GetNodeValue(node, v);
        this->Two->AddPoint(v[0], v[1], v[2], v[3]);
      }
      this->First = k;
    }
    return this->Two->GetValue(place);
  }

private:
  vtkPiecewiseFunction* All;
  vtkNew<vtkPiecewiseFunction> Two;
  int First = -1;
};

} // namespace

vtkSmartPointer<vtkColorTransferFunction> OverLogarithms(vtkColorTransferFunction* function)
{
  auto result = vtkSmartPointer<vtkColorTransferFunction>::New();
  result->DeepCopy(function);
  result->RemoveAllPoints();
  result->SetScaleToLinear();
  // Which VTK does not copy.
  result->SetUseBelowRangeColor(function->GetUseBelowRangeColor());
  result->SetBelowRangeColor(function->GetBelowRangeColor());
  result->SetUseAboveRangeColor(function->GetUseAboveRangeColor());
  result->SetAboveRangeColor(function->GetAboveRangeColor());
  result->AllowDuplicateScalarsOn(); // whatever the function allows now: none of its nodes is lost
  for (int k = 0; k < function->GetSize(); ++k) {
    double node[6]; // place, red, green, blue, midpoint, sharpness
    function->GetNodeValue(k, node);
    result->AddRGBPoint(std::log10(node[0]), node[1], node[2], node[3], node[4], node[5]);
  }
  return result;
}

std::vector<double> AtRising(vtkPiecewiseFunction* function, const std::vector<double>& places)
{
  const std::vector<double> nodes = NodesOf(function);
  Stretch stretch(function);
  std::size_t behind = 0;        // nodes at or before the place
  std::optional<double> outside; // on this side of all nodes
  std::vector<double> values;
  values.reserve(places.size());
  for (const double place : places) {
    for (; behind < nodes.size() && nodes[behind] <= place; ++behind) {
      outside.reset();
    }
    if (behind > 0 && behind < nodes.size()) {
      values.push_back(stretch.at(static_cast<int>(behind) - 1, place));
    } else if (behind > 0 && place == nodes.back()) {
      values.push_back(function->GetValue(place));
    } else {
      outside = outside ? *outside : function->GetValue(place);
      values.push_back(*outside);
    }
  }
  return values;
}

} // namespace inr
