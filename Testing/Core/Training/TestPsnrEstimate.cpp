// SPDX-License-Identifier: BSD-3-Clause
//
// Estimates of the PSNR against that of all voxels, of data most of which are nothing.
#include "Core/Training/Quality/PsnrEstimate.h"
#include "Core/Training/Samples/VoxelDraw.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

namespace test::psnr_estimate {

/// Four spots of five voxels' width in a cube of zeros.
Field<float> Spots()
{
  constexpr std::int64_t edge = 64;
  Field<float> field{glm::i64vec3(edge), inr::ScalarType::Float32,
                     std::vector<float>(static_cast<std::size_t>(edge * edge * edge))};
  for (const glm::i64vec3& centre : {glm::i64vec3(13, 20, 47), glm::i64vec3(50, 9, 11),
                                     glm::i64vec3(30, 55, 33), glm::i64vec3(44, 40, 58)}) {
    for (std::int64_t k = 0; k < 125; ++k) {
      const glm::i64vec3 offset(k % 5 - 2, k / 5 % 5 - 2, k / 25 - 2);
      const glm::i64vec3 at = centre + offset;
      field.values[static_cast<std::size_t>((at.z * edge + at.y) * edge + at.x)] = std::exp(
          -static_cast<float>(offset.x * offset.x + offset.y * offset.y + offset.z * offset.z) /
          1.5f);
    }
  }
  return field;
}

inr::TrainingOptions Options(std::uint64_t steps)
{
  inr::TrainingOptions options = Steps(steps);
  options.description = SmallDescription();
  options.storedAs = inr::ParameterType::Half;
  return options;
}

/// A model of spots.
struct Spotted
{
  double estimate(const inr::PsnrEstimate& estimate) const
  {
    const inr::Layout layout(this->Model->description);
    const inr::ModelViewStorage views(this->Model->description, layout,
                                      this->Model->parameters.data());
    return estimate.measure(views.view(), inr::EvaluateKernelFor(inr::ChooseInstructionSet("")),
                            inr::StopCheck());
  }

  Field<float> Data = Spots();
  inr::Arena Threads{2};
  inr::InMemorySource Source{this->Data.data(), 0, 1};
  inr::ModelPointer Model = inr::TrainModel(this->Data.data(), {}, Options(150));
};

TEST(PsnrEstimate, KnowsWhatAConstantLeaves)
{
  const Field<float> data = Spots();
  const inr::Arena threads(2);
  const inr::InMemorySource source(data.data(), 0, 1);
  double sum = 0;
  double squares = 0;
  for (const float value : data.values) {
    sum += value;
    squares += double{value} * value;
  }
  const auto count = static_cast<double>(data.values.size());
  const double variance = squares / count - sum / count * (sum / count);
  const double found = inr::PsnrEstimate(source, 1, threads).squaredErrorOfConstant();
  EXPECT_NEAR(found / variance, 1, 0.1);
}

TEST(PsnrEstimate, IsNearThePsnrOfAllVoxelsOfLocalisedData)
{
  const Spotted spots;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const inr::PsnrEstimate estimate(spots.Source, seed, spots.Threads);
    EXPECT_NEAR(spots.estimate(estimate), spots.Model->quality->psnr, 0.3) << seed;
  }
}

TEST(PsnrEstimate, EndsATrainingOnLocalisedDataAtItsTarget)
{
  inr::TrainingOptions options = Options(2000);
  options.targetPsnr = 59;
  const double psnr = inr::TrainModel(Spots().data(), {}, options)->quality->psnr;
  EXPECT_GT(psnr, 58.7);
}

TEST(PsnrEstimate, KnowsAllOfAFewFiniteVoxels)
{
  Field<float> field{{64, 64, 64}, inr::ScalarType::Float32, std::vector<float>(64 * 64 * 64, NAN)};
  for (std::size_t k = 0; k < 6; ++k) {
    field.values[k * 41000 + 77] = static_cast<float>(k);
  }
  const inr::Arena threads(2);
  const inr::InMemorySource source(field.data(), 0, 5);
  const inr::PsnrEstimate estimate(source, 1, threads, 1 << 10);
  EXPECT_EQ(estimate.known(), 1 << 10);
  // Of (0, 1, ..., 5) / 5 and zeros.
  EXPECT_NEAR(estimate.squaredError(std::vector<float>(1 << 10)), 55.0 / 25 / 6, 0.05);
}

TEST(VoxelDraw, GivesMeansThatAreNotBiased)
{
  Field<float> field = Spots();
  field.values[5] = NAN; // a block is looked at voxel by voxel
  double sum = 0;
  for (std::size_t k = 0; k < field.values.size(); ++k) {
    sum += k == 5 ? 0.0 : field.values[k] + static_cast<double>(k % 7);
  }
  const double mean = sum / static_cast<double>(field.values.size() - 1);
  const inr::VoxelDraw draw({field.data(), 0, 1}, inr::Arena(2));
  constexpr std::uint64_t count = 1 << 17;
  double drawn = 0;
  double weights = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const inr::VoxelDraw::Voxel voxel = draw.voxel(9, k);
    const std::int64_t at = (voxel.at.z * 64 + voxel.at.y) * 64 + voxel.at.x;
    ASSERT_NE(at, 5);
    drawn +=
        voxel.weight * (field.values[static_cast<std::size_t>(at)] + static_cast<double>(at % 7));
    weights += voxel.weight;
  }
  EXPECT_NEAR(weights / count, 1.0, 0.01);
  EXPECT_NEAR(drawn / count, mean, 0.02 * mean);
}

} // namespace test::psnr_estimate
