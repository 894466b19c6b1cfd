// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Representations/Mapper/Scene/TransferFunctionBuilder.h"

#include <vtkColorTransferFunction.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace test {

constexpr inr::ValueSpan Everything{-1e300, 1e300};

class TransferFunctions : public testing::Test
{
protected:
  TransferFunctions()
  {
    this->property->SetColor(this->colour);
    this->property->SetScalarOpacity(this->opacity);
  }

  inr::TransferFunction build(const inr::ValueSpan& values = Everything)
  {
    return inr::BuildTransferFunction(this->property, values);
  }

  vtkNew<vtkColorTransferFunction> colour;
  vtkNew<vtkPiecewiseFunction> opacity;
  vtkNew<vtkVolumeProperty> property;
};

/// The lookup that TransferFunction documents.
inline glm::vec4 LookUp(const inr::TransferFunction& table, double value)
{
  if (value < table.low || value > table.high) {
    return value < table.low ? table.below : table.above;
  }
  const double t = table.logarithmic
                       ? std::log(value / table.low) / std::log(table.high / table.low)
                       : (value - table.low) / (table.high - table.low);
  const double position = t * static_cast<double>(table.table.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(position), table.table.size() - 2);
  return glm::mix(table.table[k], table.table[k + 1], static_cast<float>(position - k));
}

inline void ExpectColour(const glm::vec4& actual, double r, double g, double b, double tolerance)
{
  EXPECT_NEAR(actual.r, r, tolerance);
  EXPECT_NEAR(actual.g, g, tolerance);
  EXPECT_NEAR(actual.b, b, tolerance);
}

} // namespace test
