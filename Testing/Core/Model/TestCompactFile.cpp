// SPDX-License-Identifier: BSD-3-Clause
//
// Files with quantised parameters: what is read is what was written.
#include "Testing/Core/Model/CompactFile.h"

#include <cmath>
#include <limits>

namespace test::compact_file {

TEST_F(CompactFile, GivesBackWhatWasWritten)
{
  const auto written = CompactModel();
  const inr::ModelPointer read = this->roundTrip(*written);
  EXPECT_EQ(read->parameters, written->parameters);
  EXPECT_EQ(read->steps, written->steps);
  EXPECT_EQ(read->storedAs, inr::ParameterType::Quantised);
  EXPECT_EQ(read->macroCells.dims, written->macroCells.dims);
  EXPECT_EQ(read->macroCells.apron, written->macroCells.apron);
  EXPECT_EQ(read->volume.direction, written->volume.direction);
  EXPECT_EQ(this->write(*read), this->Bytes);
}

TEST_F(CompactFile, RoundsToTheNearestMultiple)
{
  auto model = CompactModel();
  model->steps[0] = 0.25f;
  model->parameters[0] = 0.30f;
  model->parameters[1] = -0.38f;
  const inr::ModelPointer read = this->roundTrip(*model);
  EXPECT_EQ(read->parameters[0], 0.25f);
  EXPECT_EQ(read->parameters[1], -0.5f);
}

TEST_F(CompactFile, TakesParametersOfAnyMagnitude)
{
  for (const float magnitude : {0.0f, 1e-44f, 1e-30f, 1.0f, 65504.0f, 1e30f, 3.4e38f}) {
    auto model = CompactModel();
    const std::vector<inr::ParameterGroup> groups = inr::ParameterGroups(model->description);
    for (std::size_t k = 0; k < groups.size(); ++k) {
      float* first = model->parameters.data() + groups[k].offset;
      model->steps[k] = inr::FinestStep(magnitude);
      for (std::uint64_t i = 0; i < groups[k].count; ++i) {
        first[i] = magnitude * (i % 2 == 0 ? 1.0f : -inr::RandomUnit(k, i));
      }
      inr::RoundToStep(first, groups[k].count, model->steps[k]);
    }
    const inr::ModelPointer read = this->roundTrip(*model);
    EXPECT_EQ(read->parameters, model->parameters) << magnitude;
    EXPECT_NEAR(read->parameters[0], magnitude, 4e-5 * magnitude + 1e-37);
  }
}

TEST_F(CompactFile, KeepsEveryMultipleOfSixteenBits)
{
  auto model = CompactModel();
  const inr::ParameterGroup last = inr::ParameterGroups(model->description).back();
  const float step = model->steps.back();
  for (std::uint64_t k = 0; k < last.count; ++k) {
    const auto multiple = static_cast<std::int16_t>(32767 - 31 * static_cast<int>(k % 2115));
    model->parameters[last.offset + k] = inr::ValueOfMultiple(multiple, step);
  }
  EXPECT_EQ(this->roundTrip(*model)->parameters, model->parameters);
}

TEST_F(CompactFile, IsMuchSmallerThanInHalfPrecision)
{
  auto half = CompactModel();
  half->storedAs = inr::ParameterType::Half;
  EXPECT_LT(2 * this->Bytes.size(), this->write(*half).size() + 2500); // besides the header
}

TEST_F(CompactFile, SizeIsExactWithParametersAndABoundWithout)
{
  auto model = CompactModel();
  const auto size = static_cast<std::int64_t>(this->Bytes.size());
  EXPECT_EQ(inr::ModelFileSize(*model), size);
  EXPECT_EQ(inr::WriteModel(*model, this->path()), size);
  model->parameters.clear();
  EXPECT_GE(inr::ModelFileSize(*model), size);
  model->steps.clear();
  EXPECT_GE(inr::ModelFileSize(*model), size);
}

TEST_F(CompactFile, SaysItsVersionAndOthersKeepTheirs)
{
  const auto version = [](const std::string& bytes) {
    return static_cast<int>(bytes[bytes.find("format_version") + 15]);
  };
  EXPECT_EQ(version(this->Bytes), 2);
  const std::string plain = this->write(*FullModel());
  EXPECT_EQ(version(plain), 1);
  EXPECT_EQ(plain.find("\x04steps"), std::string::npos);
}

/// A model with so many macro-cells, whose ranges the caller fills.
std::shared_ptr<inr::Model> WithCells(std::int64_t count)
{
  auto model = CompactModel();
  model->macroCells = inr::MakeMacroCells({count * 16, 1, 1}, 16);
  return model;
}

TEST_F(CompactFile, RangesContainWhatTheyWere)
{
  constexpr std::int64_t count = 20000;
  auto model = WithCells(count);
  std::vector<inr::ValueRange>& ranges = model->macroCells.ranges;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    float low = inr::RandomUnit(1, k);
    if (k % 2 == 0) { // on a bound that can be stored, or beside it
      low = std::nextafter(static_cast<float>(k / 2 % 256) / 255.0f,
                           static_cast<float>(k % 3) - 0.5f);
      low = std::fmin(std::fmax(low, 0.0f), 1.0f);
    }
    ranges[k] = {low, low + (1 - low) * inr::RandomUnit(2, k) * static_cast<float>(k % 5 != 0)};
  }
  const inr::ModelPointer read = this->roundTrip(*model);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const inr::ValueRange& stored = read->macroCells.ranges[k];
    ASSERT_LE(stored.low, ranges[k].low) << k;
    ASSERT_GE(stored.high, ranges[k].high) << k;
    ASSERT_LT(ranges[k].low - stored.low, 1.00001f / 255) << k;
    ASSERT_LT(stored.high - ranges[k].high, 1.00001f / 255) << k;
  }
}

TEST_F(CompactFile, RangesKeepEmptinessAndWhatIsExact)
{
  auto model = WithCells(4);
  model->macroCells.ranges = {{}, {0, 0}, {1, 1}, {-0.5f, 1.5f}};
  const inr::ModelPointer read = this->roundTrip(*model);
  const std::vector<inr::ValueRange>& ranges = read->macroCells.ranges;
  EXPECT_TRUE(ranges[0].empty());
  EXPECT_EQ(ranges[1].high, 0.0f);
  EXPECT_EQ(ranges[2].low, 1.0f);
  EXPECT_EQ(ranges[3].low, 0.0f); // the output never leaves [0, 1]
  EXPECT_EQ(ranges[3].high, 1.0f);
}

TEST_F(CompactFile, WrongCountsOfParametersAreNoted)
{
  auto model = CompactModel();
  model->parameters.pop_back();
  this->expectUnwritable(*model, "parameters");
  EXPECT_THROW(inr::ModelFileSize(*model), inr::Error);
}

TEST_F(CompactFile, NeedsNoMacroCells)
{
  auto model = CompactModel();
  model->macroCells = {};
  EXPECT_TRUE(this->roundTrip(*model)->macroCells.empty());
}

TEST_F(CompactFile, WritesNothingThatCannotBeRead)
{
  const auto good = CompactModel();
  const auto with = [&](const auto& change) {
    auto model = std::make_shared<inr::Model>(*good);
    change(*model);
    return *model;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float step : {0.0f, -0.5f, nan, HUGE_VALF, 1e-40f, 3e38f}) {
    this->expectUnwritable(with([&](auto& model) { model.steps[1] = step; }), "step");
  }
  this->expectUnwritable(with([](auto& model) { model.steps.pop_back(); }), "step");
  this->expectUnwritable(with([](auto& model) { model.steps.clear(); }), "step");
  this->expectUnwritable(with([](auto& model) { model.parameters[3] = 1e6f; }), "parameter 3");
  this->expectUnwritable(with([&](auto& model) { model.parameters[3] = nan; }), "parameter 3");
  this->expectUnwritable(with([&](auto& model) { model.macroCells.ranges[2].low = nan; }),
                         "range 2");
  EXPECT_EQ(ReadBytes(this->path()), this->Bytes);
}

} // namespace test::compact_file
