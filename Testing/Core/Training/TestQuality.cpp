// SPDX-License-Identifier: BSD-3-Clause
//
// The streamed quality report against the same definitions written out directly.
#include "Core/Error.h"
#include "Core/Training/Quality/Quality.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace test::quality {

struct Comparison
{
  explicit Comparison(Field<float> field) : Reference(std::move(field))
  {
    inr::Description description = SmallDescription();
    description.network.outputActivation = inr::Activation::Sigmoid; // inside [0, 1]
    const auto model = RandomModel(description);
    this->Info.dims = this->Reference.dims;
    this->Info.low = -1;
    this->Info.high = 1;
    const auto evaluator = inr::MakeEvaluator(model);
    const inr::Arena arena(3);
    this->Report =
        inr::MeasureQuality(*evaluator, this->Reference.data(), this->Info, 8, arena, {});
    this->Decoded.resize(this->Reference.values.size());
    inr::EvaluateLattice(*evaluator, arena,
                         inr::VoxelLattice(this->Info.dims, {0, 0, 0}, this->Info.dims),
                         this->Decoded.data());
  }

  std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    return static_cast<std::size_t>(x + this->Info.dims.x * (y + this->Info.dims.y * z));
  }
  double reference(std::size_t k) const { return (this->Reference.values[k] + 1.0) / 2.0; }

  Field<float> Reference;
  inr::VolumeInfo Info;
  std::vector<float> Decoded;
  inr::DecodedReport Report;
};

/// SSIM of one window with two-pass moments; NaN if it holds a NaN.
double DirectWindow(const Comparison& c, std::int64_t x, std::int64_t y, std::int64_t z)
{
  double meanA = 0;
  double meanB = 0;
  const auto visit = [&](const auto& function) {
    for (int k = 0; k < 343; ++k) {
      const std::size_t at = c.index(x + k % 7, y + k / 7 % 7, z + k / 49);
      function(c.reference(at), static_cast<double>(c.Decoded[at]));
    }
  };
  visit([&](double a, double b) {
    meanA += a / 343;
    meanB += b / 343;
  });
  double aa = 0;
  double bb = 0;
  double ab = 0;
  visit([&](double a, double b) {
    aa += (a - meanA) * (a - meanA) / 342;
    bb += (b - meanB) * (b - meanB) / 342;
    ab += (a - meanA) * (b - meanB) / 342;
  });
  return (2 * meanA * meanB + 1e-4) * (2 * ab + 9e-4) /
         ((meanA * meanA + meanB * meanB + 1e-4) * (aa + bb + 9e-4));
}

double DirectSsim(const Comparison& c)
{
  double sum = 0;
  int windows = 0;
  for (std::int64_t z = 0; z + 7 <= c.Info.dims.z; ++z) {
    for (std::int64_t y = 0; y + 7 <= c.Info.dims.y; ++y) {
      for (std::int64_t x = 0; x + 7 <= c.Info.dims.x; ++x) {
        const double score = DirectWindow(c, x, y, z);
        if (!std::isnan(score)) {
          sum += score;
          ++windows;
        }
      }
    }
  }
  return sum / windows;
}

void ExpectDirectValues(const Comparison& c)
{
  double squared = 0;
  double largest = 0;
  int finite = 0;
  for (std::size_t k = 0; k < c.Decoded.size(); ++k) {
    const double difference = std::abs(c.reference(k) - c.Decoded[k]);
    if (!std::isnan(difference)) {
      squared += difference * difference;
      largest = std::max(largest, difference);
      ++finite;
    }
  }
  EXPECT_NEAR(c.Report.quality.psnr, -10 * std::log10(squared / finite), 1e-6);
  EXPECT_NEAR(c.Report.quality.maxError, 2 * largest, 1e-6);
  EXPECT_NEAR(c.Report.quality.ssim, DirectSsim(c), 1e-7);
}

TEST(Quality, EqualsTheDefinitions) { ExpectDirectValues(Comparison(WaveField())); }

TEST(Quality, LeavesOutWhatIsNotFinite)
{
  Field<float> field = WaveField();
  field.values[1234] = std::numeric_limits<float>::quiet_NaN();
  ExpectDirectValues(Comparison(std::move(field)));
}

TEST(Quality, SsimIsUndefinedForThinVolumes)
{
  const Comparison flat(WaveField<float>({20, 20, 3}, inr::ScalarType::Float32, -1, 1));
  EXPECT_TRUE(std::isnan(flat.Report.quality.ssim));
  EXPECT_TRUE(std::isfinite(flat.Report.quality.psnr));
}

TEST(Quality, AsksWithinASlice)
{
  const Field<float> field = WaveField<float>({512, 256, 1}, inr::ScalarType::Float32, -1, 1);
  inr::VolumeInfo info;
  info.low = -1;
  const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()));
  int asked = 0;
  const auto keepGoing = [&](double fraction) { return ++asked > 0 && fraction < 0.4; };
  EXPECT_THROW(
      inr::MeasureQuality(*evaluator, field.data(), info, 16, inr::Arena(2), keepGoing, 1 << 15),
      inr::Error);
  EXPECT_EQ(asked, 3); // at 0, 1/4 and 1/2
}

void ExpectDirectRanges(const Comparison& c)
{
  const inr::MacroCells& cells = c.Report.macroCells;
  EXPECT_EQ(cells.provenance, inr::MacroCellProvenance::Decoded);
  EXPECT_EQ(cells.apron * glm::dvec3(c.Info.dims), glm::dvec3(inr::MacroCellApron));
  for (std::int64_t cell = 0; cell < cells.dims.x * cells.dims.y * cells.dims.z; ++cell) {
    const glm::i64vec3 at = inr::GridPlace(cell, cells.dims);
    const glm::i64vec3 begin =
        glm::max(at * std::int64_t{8} - inr::MacroCellApron, glm::i64vec3(0));
    const glm::i64vec3 end =
        glm::min(at * std::int64_t{8} + std::int64_t{8} + inr::MacroCellApron, c.Info.dims);
    inr::ValueRange expected;
    for (std::int64_t z = begin.z; z < end.z; ++z) {
      for (std::int64_t y = begin.y; y < end.y; ++y) {
        for (std::int64_t x = begin.x; x < end.x; ++x) {
          expected.extend(c.Decoded[c.index(x, y, z)]);
        }
      }
    }
    const inr::ValueRange& range = cells.ranges[static_cast<std::size_t>(cell)];
    ASSERT_EQ(range.low, expected.low) << cell;
    ASSERT_EQ(range.high, expected.high) << cell;
  }
}

TEST(Quality, MacroCellsHoldTheirVoxelsAndAnApron) { ExpectDirectRanges(Comparison(WaveField())); }

// They are compared in parts; each voxel and each window counts once.
TEST(Quality, OfLargeSlicesEqualsTheDefinitions)
{
  const Comparison c(WaveField<float>({390, 388, 7}, inr::ScalarType::Float32, -1, 1));
  ExpectDirectValues(c);
  ExpectDirectRanges(c);
}

} // namespace test::quality
