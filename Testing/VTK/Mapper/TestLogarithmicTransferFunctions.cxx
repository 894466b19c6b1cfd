// SPDX-License-Identifier: BSD-3-Clause
// The same of colours on a logarithmic scale.
#include "TransferFunctionsCase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using test::ExpectColour;
using test::LookUp;
using LogarithmicTransferFunctions = test::TransferFunctions;

TEST_F(LogarithmicTransferFunctions, AreSampledInLogarithms)
{
  this->colour->AddRGBPoint(1e-3, 0, 0, 0);
  this->colour->AddRGBPoint(1e3, 1, 1, 1);
  this->colour->SetScaleToLog10();
  this->opacity->AddPoint(1e-3, 0);
  this->opacity->AddPoint(1e3, 1);
  this->colour->ClampingOff();
  const auto table = this->build();
  EXPECT_TRUE(table.logarithmic);
  // In log space 1 is half way, 0.01 one sixth; the opacity stays linear in the value.
  ExpectColour(LookUp(table, 1.0), 0.5, 0.5, 0.5, 0.005);
  ExpectColour(LookUp(table, 1e-2), 1 / 6.0, 1 / 6.0, 1 / 6.0, 0.005);
  EXPECT_NEAR(LookUp(table, 500.0).a, 0.5, 0.005);
  ExpectColour(table.table.back(), 1, 1, 1, 1e-6);
}

/// Nodes that are evenly apart on a logarithmic axis, as ParaView's maps have them: no more entries
/// than their logarithms ask for.
TEST_F(LogarithmicTransferFunctions, AreAsFineAsLogarithmsAskFor)
{
  for (int k = 0; k < 256; ++k) {
    this->colour->AddRGBPoint(std::pow(10.0, k / 63.75), k / 255.0, 0.5 + 0.5 * std::sin(0.1 * k),
                              0.25);
  }
  this->colour->SetScaleToLog10();
  this->colour->SetColorSpaceToLab();
  this->opacity->AddPoint(10, 0.2, 0.5, 0.5);
  this->opacity->AddPoint(100, 0.6);
  this->opacity->AddPoint(1000, 0.4);
  this->opacity->ClampingOff();
  const auto table = this->build();
  EXPECT_EQ(table.table.size(), 1025u);
  for (double value = 1.001; value < 1e4; value *= 1.037) {
    double rgb[3];
    this->colour->GetColor(value, rgb);
    const glm::vec4 actual = LookUp(table, value);
    ExpectColour(actual, rgb[0], rgb[1], rgb[2], 0.01);
    if (std::abs(value - 10) > 0.2 && std::abs(value - 1000) > 20) { // where it jumps
      EXPECT_NEAR(actual.a, this->opacity->GetValue(value), 0.01) << value;
    }
  }
}

/// As ParaView leaves them when a scale becomes logarithmic: stretched over the data, whatever
/// these are.
TEST_F(LogarithmicTransferFunctions, HaveOpacitiesBelowZero)
{
  this->colour->AddRGBPoint(0.01, 1, 0, 0);
  this->colour->AddRGBPoint(100, 0, 0, 1);
  this->colour->SetScaleToLog10();
  this->opacity->AddPoint(-200, 0);
  this->opacity->AddPoint(100, 0.9);
  this->opacity->AddPoint(-50, 0.1);
  this->opacity->AddPoint(-49.9, 0.6);
  const auto table = this->build();
  EXPECT_EQ(table.below.a, 0);
  for (const double value : {-199.0, -100.0, -50.5, -49.0, -1.0, 0.0, 3.0, 20.0, 99.0}) {
    double rgb[3];
    this->colour->GetColor(std::max(value, 0.01), rgb);
    const glm::vec4 actual = LookUp(table, value);
    ExpectColour(actual, rgb[0], rgb[1], rgb[2], 0.01);
    EXPECT_NEAR(actual.a, this->opacity->GetValue(value), 0.01) << value;
  }
}

/// Between the ends of the colours and those of the opacities; and opacities on a logarithmic axis
/// of their own.
TEST_F(LogarithmicTransferFunctions, KeepWhatTheFunctionsAreSetTo)
{
  this->colour->AddRGBPoint(10, 1, 1, 0);
  this->colour->AddRGBPoint(1000, 1, 0, 1);
  this->colour->SetScaleToLog10();
  this->colour->SetBelowRangeColor(0.1, 0.2, 0.3);
  this->colour->SetAboveRangeColor(0.4, 0.5, 0.6);
  this->colour->UseBelowRangeColorOn();
  this->colour->UseAboveRangeColorOn();
  this->opacity->AddPoint(1, 0.1);
  this->opacity->AddPoint(1e4, 0.9);
  this->opacity->UseLogScaleOn();
  const auto table = this->build();
  ExpectColour(LookUp(table, 5), 0.1, 0.2, 0.3, 1e-6);
  ExpectColour(LookUp(table, 5000), 0.4, 0.5, 0.6, 1e-6);
  for (double value = 1.1; value < 9e3; value *= 1.7) {
    EXPECT_NEAR(LookUp(table, value).a, this->opacity->GetValue(value), 0.002) << value;
  }
  EXPECT_NEAR(LookUp(table, 100).a, 0.5, 0.002);
}

/// Two nodes at one value, between which the colour leaps, as ParaView's maps may have them.
TEST_F(LogarithmicTransferFunctions, LeapWhereTheFunctionDoes)
{
  this->colour->AllowDuplicateScalarsOn();
  this->colour->AddRGBPoint(1, 0, 0, 0);
  this->colour->AddRGBPoint(60, 1, 0, 0);
  this->colour->AddRGBPoint(60, 0, 0, 1);
  this->colour->AddRGBPoint(240, 1, 1, 1);
  this->colour->SetScaleToLog10();
  this->opacity->AddPoint(1, 0.5);
  this->opacity->AddPoint(240, 0.5);
  for (const bool allowed : {true, false}) { // what is there stays
    this->colour->SetAllowDuplicateScalars(allowed);
    const auto table = this->build();
    for (const double value : {2.0, 30.0, 59.0, 61.0, 120.0}) {
      double rgb[3];
      this->colour->GetColor(value, rgb);
      ExpectColour(LookUp(table, value), rgb[0], rgb[1], rgb[2], 0.005);
    }
    EXPECT_GT(LookUp(table, 59).r, 0.99);
  }
}

/// Which takes time for nodes and for entries, not for each node at each entry.
TEST_F(LogarithmicTransferFunctions, MayHaveTenThousandOpacities)
{
  const auto alpha = [](double x) { return 0.3 + 0.2 * std::cos(2 * x); };
  std::vector<double> opacities;
  for (int k = 0; k < 10000; ++k) {
    const double x = (k + 0.499 * std::sin(k)) / 2500; // logarithm, to 4
    opacities.insert(opacities.end(), {std::pow(10.0, x), alpha(x)});
  }
  this->opacity->FillFromDataPointer(10000, opacities.data());
  this->colour->AddRGBPoint(1, 0, 0, 0);
  this->colour->AddRGBPoint(1e4, 1, 1, 1);
  this->colour->SetScaleToLog10();
  const auto table = this->build();
  for (double x = 0.001; x < 3.999; x += 0.00737) {
    const glm::vec4 actual = LookUp(table, std::pow(10.0, x));
    ExpectColour(actual, x / 4, x / 4, x / 4, 0.002);
    EXPECT_NEAR(actual.a, alpha(x), 0.002) << x;
  }
}

TEST_F(LogarithmicTransferFunctions, AreKeptWhereNoOpacityIsLostByThem)
{
  this->colour->AddRGBPoint(0.1, 0, 0, 0);
  this->colour->AddRGBPoint(1e6, 1, 1, 1);
  this->colour->SetScaleToLog10();
  this->opacity->AddPoint(-5, 0);
  this->opacity->AddPoint(0, 0); // which hides what is 0
  this->opacity->AddPoint(0.1, 1);
  this->opacity->AddPoint(1e6, 1);
  const auto table = this->build();
  EXPECT_TRUE(table.logarithmic);
  EXPECT_EQ(table.low, 0.1);
  EXPECT_NEAR(table.below.a, 0, 0.01);
}

TEST_F(LogarithmicTransferFunctions, HaveTheirEntriesWhereThereAreValues)
{
  this->colour->AddRGBPoint(1e-30, 0, 0, 0);
  this->colour->AddRGBPoint(1e30, 1, 1, 1);
  this->colour->SetScaleToLog10();
  this->opacity->AddPoint(1.5, 0);
  this->opacity->AddPoint(1.6, 0.5);
  this->opacity->AddPoint(1.7, 0);
  const auto table = this->build({1, 10});
  EXPECT_EQ(table.low, 1);
  EXPECT_EQ(table.high, 10);
  for (double value = 1; value < 10; value *= 1.02) {
    EXPECT_NEAR(LookUp(table, value).a, this->opacity->GetValue(value), 0.005) << value;
    EXPECT_NEAR(LookUp(table, value).g, (std::log10(value) + 30) / 60, 0.001) << value;
  }
}

/// And nothing of what is outside, however their logarithms are rounded.
TEST_F(LogarithmicTransferFunctions, HaveTheirOwnColorsAtTheEnds)
{
  this->colour->SetScaleToLog10();
  this->colour->UseBelowRangeColorOn();
  this->colour->UseAboveRangeColorOn();
  this->opacity->AddPoint(1, 0.5);
  for (const bool clamps : {true, false}) {
    this->colour->SetClamping(clamps);
    for (const double low : {0.003, 1.0, 7.0}) {
      for (const double high : {20.0, 300.0, 700.0, 2000.0, 3000.0, 4095.0}) {
        this->colour->RemoveAllPoints();
        this->colour->AddRGBPoint(low, 0.25, 0.5, 1);
        this->colour->AddRGBPoint(high, 1, 0.5, 0.25);
        const auto table = this->build({low, high});
        ExpectColour(table.table.front(), 0.25, 0.5, 1, 1e-6);
        ExpectColour(table.table.back(), 1, 0.5, 0.25, 1e-6);
      }
    }
  }
}

TEST_F(LogarithmicTransferFunctions, MayHaveOneColor)
{
  this->colour->AddRGBPoint(100, 0.25, 0.5, 1);
  this->colour->SetScaleToLog10();
  this->opacity->AddPoint(3, 0.1);
  this->opacity->AddPoint(230, 0.9);
  const auto table = this->build({-5, 500});
  for (const double value : {-5.0, 3.0, 50.0, 100.0, 230.0, 500.0}) {
    ExpectColour(LookUp(table, value), 0.25, 0.5, 1, 1e-6);
  }
}

} // namespace
