// SPDX-License-Identifier: BSD-3-Clause
// The table must say, at any value, what VTK's two functions say.
#include "TransferFunctionsCase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using test::Everything;
using test::ExpectColour;
using test::LookUp;
using test::TransferFunctions;

TEST_F(TransferFunctions, AgreeWithVtkBetweenTheNodes)
{
  this->colour->AddRGBPoint(-3, 1, 0, 0);
  this->colour->AddRGBPoint(2, 0, 1, 0);
  this->colour->AddRGBPoint(10, 0, 0.2, 1);
  this->opacity->AddPoint(0, 0);
  this->opacity->AddPoint(4, 0.7);
  this->opacity->AddPoint(20, 0.1);
  const auto table = this->build();
  EXPECT_EQ(table.low, -3);
  EXPECT_EQ(table.high, 20);
  EXPECT_FALSE(table.logarithmic);
  for (double value = -5; value < 22; value += 0.37) {
    double rgb[3];
    this->colour->GetColor(value, rgb);
    const glm::vec4 actual = LookUp(table, value);
    ExpectColour(actual, rgb[0], rgb[1], rgb[2], 0.005);
    EXPECT_NEAR(actual.a, this->opacity->GetValue(value), 0.005) << value;
  }
}

TEST_F(TransferFunctions, EndWhereClampingIsOff)
{
  this->colour->AddRGBPoint(0, 1, 1, 0);
  this->colour->AddRGBPoint(1, 1, 0, 1);
  this->opacity->AddPoint(0, 0.5);
  this->opacity->AddPoint(1, 0.25);
  auto table = this->build();
  EXPECT_EQ(table.below, glm::vec4(1, 1, 0, 0.5));
  EXPECT_EQ(table.above, glm::vec4(1, 0, 1, 0.25));

  this->opacity->ClampingOff();
  this->colour->ClampingOff();
  table = this->build();
  EXPECT_EQ(table.below, glm::vec4(0));
  EXPECT_EQ(table.above, glm::vec4(0));
  ExpectColour(table.table.front(), 1, 1, 0, 1e-6);
  ExpectColour(table.table.back(), 1, 0, 1, 1e-6);
  EXPECT_NEAR(table.table.front().a, 0.5, 1e-6);
  EXPECT_NEAR(table.table.back().a, 0.25, 1e-6);
}

TEST_F(TransferFunctions, ShowColoursBelowAndAboveTheRange)
{
  this->colour->AddRGBPoint(0, 1, 1, 0);
  this->colour->AddRGBPoint(1, 1, 0, 1);
  this->colour->SetBelowRangeColor(0.1, 0.2, 0.3);
  this->colour->SetAboveRangeColor(0.4, 0.5, 0.6);
  this->colour->UseBelowRangeColorOn();
  this->colour->UseAboveRangeColorOn();
  this->opacity->AddPoint(0, 1);
  this->opacity->AddPoint(1, 1);
  const auto table = this->build();
  ExpectColour(table.below, 0.1, 0.2, 0.3, 1e-6);
  ExpectColour(table.above, 0.4, 0.5, 0.6, 1e-6);
  ExpectColour(table.table.front(), 1, 1, 0, 1e-6);
  ExpectColour(table.table.back(), 1, 0, 1, 1e-6);
}

TEST_F(TransferFunctions, ResolveNodesThatAreCloseTogether)
{
  this->colour->AddRGBPoint(0, 1, 1, 1);
  this->opacity->AddPoint(0, 0);
  this->opacity->AddPoint(5000, 0);
  this->opacity->AddPoint(5001, 1);
  this->opacity->AddPoint(5002, 0);
  this->opacity->AddPoint(10000, 0);
  const auto table = this->build();
  EXPECT_GT(LookUp(table, 5001.0).a, 0.7);
  EXPECT_LE(table.table.size(), 16385u);
}

/// They keep their area, wherever they are between entries, and their colour.
TEST_F(TransferFunctions, HavePeaksThatAreNarrowerThanAnEntry)
{
  for (const double half : {10.0, 3.0}) {
    for (const double middle : {500000.0, 123456.7, 999900.0}) {
      this->colour->RemoveAllPoints();
      this->opacity->RemoveAllPoints();
      this->colour->AddRGBPoint(0, 0, 0, 1);
      for (const double side : {-1.0, 1.0}) {
        this->colour->AddRGBPoint(middle + side * half, 1, 0.5, 0);
        this->colour->AddRGBPoint(middle + side * 1.1 * half, 0, 0, 1);
      }
      this->colour->AddRGBPoint(1e6, 0, 0, 1);
      this->opacity->AddPoint(0, 0);
      this->opacity->AddPoint(middle - half, 0);
      this->opacity->AddPoint(middle, 0.8);
      this->opacity->AddPoint(middle + half, 0);
      this->opacity->AddPoint(1e6, 0);
      const auto table = this->build();
      ASSERT_EQ(table.table.size(), 16385u);
      double area = 0;
      glm::dvec4 shown(0);
      for (const glm::vec4& entry : table.table) {
        area += 1e6 / 16384 * entry.a;
        shown = entry.a > shown.a ? glm::dvec4(entry) : shown;
      }
      EXPECT_NEAR(area, 0.8 * half, 0.1 * half) << middle;
      ExpectColour(glm::vec4(shown), 1, 0.5, 0, 0.01);
    }
  }
}

/// Whatever their width and wherever they are; rays and surfaces at their top look there.
TEST_F(TransferFunctions, ReachTheTopOfPeaks)
{
  this->colour->AddRGBPoint(0, 1, 1, 1);
  for (const double half : {0.05, 0.01, 0.002, 0.001, 0.0003}) {
    for (const double middle : {0.5 + 0.5 / 1024, 0.3, 0.7071}) {
      this->opacity->RemoveAllPoints();
      for (const double side : {-1.0, 0.0, 1.0}) {
        this->opacity->AddPoint(middle + side * half, side == 0 ? 0.9 : 0);
      }
      this->opacity->AddPoint(0, 0);
      this->opacity->AddPoint(1, 0);
      EXPECT_NEAR(LookUp(this->build(), middle).a, 0.9, 0.012) << half << " around " << middle;
    }
  }
}

TEST_F(TransferFunctions, HaveTheirEntriesWhereThereAreValues)
{
  const inr::ValueSpan values{-1, 1};
  for (const double far : {2.0, 1e4, 1e9, 1e300}) {
    for (const double side : {-1.0, 1.0}) {
      this->colour->RemoveAllPoints();
      this->opacity->RemoveAllPoints();
      this->colour->AddRGBPoint(-1, 0, 0, 1);
      this->colour->AddRGBPoint(1, 1, 0, 0);
      this->colour->AddRGBPoint(side * far, 1, 1, 1);
      this->opacity->AddPoint(-0.25, 0);
      this->opacity->AddPoint(0, 0.5);
      this->opacity->AddPoint(0.25, 0);
      this->opacity->AddPoint(side * far, 1);
      const auto table = this->build(values);
      for (double value = -1; value <= 1; value += 0.0625) {
        double rgb[3];
        this->colour->GetColor(value, rgb);
        ExpectColour(LookUp(table, value), rgb[0], rgb[1], rgb[2], 0.005);
        EXPECT_NEAR(LookUp(table, value).a, this->opacity->GetValue(value), 0.005) << value;
      }
      // What no value meets is not to be thought opaque.
      EXPECT_LT(side < 0 ? table.below.a : table.above.a, 0.5);
    }
  }
}

/// All that a double can tell apart.
TEST_F(TransferFunctions, MayBeNarrowBesideTheirValues)
{
  constexpr double low = 1e15;
  constexpr double width = 64; // of 512 values
  this->colour->AddRGBPoint(low, 0, 0, 0);
  this->colour->AddRGBPoint(low + width, 1, 1, 1);
  this->opacity->AddPoint(low, 0.2);
  this->opacity->AddPoint(low + width, 0.8);
  const auto table = this->build({low, low + width});
  for (double k = 0; k <= width; k += 4) {
    EXPECT_NEAR(LookUp(table, low + k).r, k / width, 0.005) << k;
    EXPECT_NEAR(LookUp(table, low + k).a, 0.2 + 0.6 * k / width, 0.005) << k;
  }
}

/// VTK's own table of colours is black where an entry is exactly at the first node.
TEST_F(TransferFunctions, HaveTheFirstColorAtItsNode)
{
  this->opacity->AddPoint(0, 1);
  for (int first = 1; first < 256; ++first) {
    this->colour->RemoveAllPoints();
    this->colour->AddRGBPoint(first, 1, 1, 1);
    this->colour->AddRGBPoint(256, 1, 1, 1);
    for (const glm::vec4& entry : this->build({0, 256}).table) {
      ASSERT_EQ(entry, glm::vec4(1)) << first;
    }
  }
}

/// As VTK has it, what is at a step is still below it.
TEST_F(TransferFunctions, MayStepAtTheLowestValue)
{
  this->colour->AddRGBPoint(0, 1, 1, 1);
  this->opacity->AllowDuplicateScalarsOn();
  for (const double first : {0.0, -50.0}) {
    this->opacity->RemoveAllPoints();
    this->opacity->AddPoint(first, 0);
    this->opacity->AddPoint(0, 0);
    this->opacity->AddPoint(0, 0.8);
    this->opacity->AddPoint(300, 0.8);
    const auto table = this->build({0, 200});
    EXPECT_EQ(LookUp(table, 0).a, 0) << first;
    EXPECT_FLOAT_EQ(LookUp(table, 1).a, 0.8f) << first;
  }
}

TEST_F(TransferFunctions, ShowASingleValue)
{
  this->colour->AddRGBPoint(-1e6, 0, 0, 0);
  this->colour->AddRGBPoint(1e6, 1, 1, 1);
  this->opacity->AddPoint(-1e6, 0);
  this->opacity->AddPoint(0, 0.75);
  this->opacity->AddPoint(0.001, 0);
  this->opacity->AddPoint(7, 0);
  this->opacity->AddPoint(7.01, 0.5);
  this->opacity->AddPoint(7.02, 0);
  for (const double value : {0.0, 7.01, -2e6, 2e6}) {
    EXPECT_NEAR(LookUp(this->build({value, value}), value).a, this->opacity->GetValue(value), 0.005)
        << value;
  }
}

/// More of them next to each other than an int can count intervals for.
TEST_F(TransferFunctions, MayJump)
{
  this->colour->AddRGBPoint(0, 1, 1, 1);
  this->opacity->AddPoint(0, 0.1);
  this->opacity->AddPoint(0.5, 0.1);
  this->opacity->AddPoint(0.5 + 1e-12, 0.7);
  this->opacity->AddPoint(1, 0.7);
  const auto table = this->build();
  EXPECT_EQ(table.table.size(), 16385u);
  EXPECT_FLOAT_EQ(LookUp(table, 0.4999).a, 0.1f);
  EXPECT_FLOAT_EQ(LookUp(table, 0.5001).a, 0.7f);
}

/// As a colour map of somebody else's program may have them: anywhere, some next to each other.
TEST_F(TransferFunctions, MayHaveTenThousandNodes)
{
  constexpr int count = 10000;
  constexpr int colourCount = 2000; // VTK itself takes seconds for 10,000 of them
  const auto red = [](double x) { return 0.5 + 0.4 * std::sin(20 * x); };
  const auto alpha = [](double x) { return 0.3 + 0.2 * std::cos(30 * x); };
  std::vector<double> colours;
  std::vector<double> opacities;
  for (int k = 0; k < count; ++k) {
    const double x = (k + 0.499 * std::sin(k)) / count;
    if (k % (count / colourCount) == 0) {
      colours.insert(colours.end(), {x, red(x), 0.25, 1 - red(x)});
    }
    opacities.insert(opacities.end(), {x, alpha(x)});
  }
  this->colour->FillFromDataPointer(colourCount, colours.data());
  this->opacity->FillFromDataPointer(count, opacities.data());
  const auto table = this->build();
  for (double x = 0.001; x < 0.999; x += 0.00137) {
    const glm::vec4 actual = LookUp(table, x);
    ExpectColour(actual, red(x), 0.25, 1 - red(x), 0.002);
    EXPECT_NEAR(actual.a, alpha(x), 0.002) << x;
  }
}

TEST_F(TransferFunctions, ExistForFunctionsWithoutOrWithOneNode)
{
  auto table = this->build();
  EXPECT_LT(table.low, table.high);
  EXPECT_GE(table.table.size(), 2u);

  this->colour->AddRGBPoint(7, 0.5, 0.25, 0.75);
  this->opacity->AddPoint(7, 0.5);
  table = this->build();
  EXPECT_EQ(table.low, 7);
  EXPECT_LT(table.low, table.high);
  EXPECT_EQ(LookUp(table, 7), glm::vec4(0.5, 0.25, 0.75, 0.5));
}

TEST_F(TransferFunctions, TakeAGrayFunctionToo)
{
  this->opacity->AddPoint(0, 0);
  this->opacity->AddPoint(1, 1);
  vtkNew<vtkPiecewiseFunction> gray;
  gray->AddPoint(0, 0.2);
  gray->AddPoint(1, 0.6);
  this->property->SetColor(gray);
  ExpectColour(LookUp(this->build(), 0.5), 0.4, 0.4, 0.4, 0.005);
}

TEST_F(TransferFunctions, AreRebuiltOnlyWhenTheyChange)
{
  this->colour->AddRGBPoint(0, 1, 1, 1);
  this->opacity->AddPoint(0, 0);
  this->opacity->AddPoint(1, 1);
  inr::TransferFunctionCache cache;
  const glm::vec4* entries = cache.get(this->property, Everything).table.data();
  this->property->SetScalarOpacityUnitDistance(3);
  EXPECT_EQ(cache.get(this->property, Everything).table.data(), entries);
  this->opacity->AddPoint(1, 0.5);
  EXPECT_EQ(LookUp(cache.get(this->property, Everything), 1.0).a, 0.5f);
}

} // namespace
