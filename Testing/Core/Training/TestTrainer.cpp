// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <thread>

namespace test::trainer {

bool SameRanges(const inr::MacroCells& a, const inr::MacroCells& b)
{
  return std::equal(a.ranges.begin(), a.ranges.end(), b.ranges.begin(), b.ranges.end(),
                    [](const inr::ValueRange& x, const inr::ValueRange& y) {
                      return x.low == y.low && x.high == y.high;
                    });
}

TEST(Trainer, LearnsASmoothField)
{
  const Field<float> field = WaveField<float>({48, 40, 36}, inr::ScalarType::Float32, -3, 5);
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(400));
  EXPECT_GT(model->quality->psnr, 36);
  EXPECT_GT(model->quality->ssim, 0.97);
  EXPECT_EQ(model->training->steps, 400u);
}

TEST(Trainer, LearnsTurbulence)
{
  std::ifstream file(INR_RAW_DIR "/les_wmag91.raw", std::ios::binary);
  Field<float> field{{91, 91, 91}, inr::ScalarType::Float32, std::vector<float>(91 * 91 * 91)};
  file.read(reinterpret_cast<char*>(field.values.data()), 4 * 91 * 91 * 91);
  ASSERT_TRUE(file.good());
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(600));
  EXPECT_GT(model->quality->psnr, 34.0);
  EXPECT_GT(model->quality->ssim, 0.90);
}

TEST(Trainer, ThreadsDoNotChangeTheResult)
{
  const Field<float> field = WaveField();
  inr::TrainingOptions options = Steps(12);
  options.threads = 1;
  const inr::ModelPointer one = inr::TrainModel(field.data(), {}, options);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    const inr::ModelPointer more = inr::TrainModel(field.data(), {}, options);
    EXPECT_EQ(one->parameters, more->parameters) << threads;
    EXPECT_TRUE(SameRanges(one->macroCells, more->macroCells));
    EXPECT_EQ(one->quality->psnr, more->quality->psnr);
    EXPECT_EQ(one->quality->ssim, more->quality->ssim);
  }
}

TEST(Trainer, SeedsDiffer)
{
  const Field<float> field = WaveField();
  inr::TrainingOptions options = Steps(3);
  const inr::ModelPointer one = inr::TrainModel(field.data(), {}, options);
  options.seed = 2;
  EXPECT_NE(one->parameters, inr::TrainModel(field.data(), {}, options)->parameters);
}

TEST(Trainer, AStopByTheClockIsRepeatedByItsSteps)
{
  const Field<float> field = WaveField();
  inr::TrainingOptions timed;
  timed.timeLimit = 1; // a busy machine takes its time for the first step, too
  const inr::ModelPointer first = inr::TrainModel(field.data(), {}, timed);
  ASSERT_GT(first->training->steps, 0u);
  inr::TrainingOptions counted = Steps(first->training->steps);
  counted.plannedSteps = first->training->plannedSteps;
  const inr::ModelPointer again = inr::TrainModel(field.data(), {}, counted);
  EXPECT_EQ(first->parameters, again->parameters);
}

TEST(Trainer, StopsAtTheTargetQuality)
{
  const Field<float> field = WaveField();
  inr::TrainingOptions options = Steps(5000);
  options.targetPsnr = 24;
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  EXPECT_LT(model->training->steps, 5000u);
  EXPECT_GT(model->quality->psnr, 23.0); // measured at voxels, stopped by an estimate
}

TEST(Trainer, QualityIsThatOfTheStoredParameters)
{
  const Field<float> field = WaveField();
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(60));
  std::vector<float> decoded(field.values.size());
  inr::EvaluateLattice(*inr::MakeEvaluator(model), inr::Arena(1),
                       inr::VoxelLattice(field.dims, {0, 0, 0}, field.dims), decoded.data());
  double largest = 0;
  for (std::size_t k = 0; k < decoded.size(); ++k) {
    const double value = inr::ValueOf(model->volume, inr::NormalisedOutput(decoded[k]));
    largest = std::max(largest, std::abs(value - field.values[k]));
  }
  EXPECT_NEAR(model->quality->maxError, largest, 1e-6);
}

template <class T> void ExpectTrains(inr::ScalarType type, double low, double high)
{
  const Field<T> field = WaveField<T>({16, 14, 12}, type, low, high);
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(80));
  EXPECT_GT(model->quality->psnr, 16) << inr::ScalarName(type);
  EXPECT_EQ(model->volume.type, type);
  EXPECT_GT(model->volume.high, model->volume.low);
}

TEST(Trainer, TakesEveryScalarType)
{
  ExpectTrains<std::int8_t>(inr::ScalarType::Int8, -100, 100);
  ExpectTrains<std::uint8_t>(inr::ScalarType::UInt8, 0, 255);
  ExpectTrains<std::int16_t>(inr::ScalarType::Int16, -30000, 30000);
  ExpectTrains<std::uint16_t>(inr::ScalarType::UInt16, 0, 60000);
  ExpectTrains<std::int32_t>(inr::ScalarType::Int32, -2e9, 2e9);
  ExpectTrains<std::uint32_t>(inr::ScalarType::UInt32, 0, 4e9);
  ExpectTrains<std::int64_t>(inr::ScalarType::Int64, -9e18, 9e18);
  ExpectTrains<std::uint64_t>(inr::ScalarType::UInt64, 0, 1.8e19);
  ExpectTrains<float>(inr::ScalarType::Float32, -1e-30, 1e-30);
  ExpectTrains<double>(inr::ScalarType::Float64, 1e10, 1e10 + 1e-3); // digits a float cannot hold
}

TEST(Trainer, LeavesOutNaNsAndInfinities)
{
  Field<float> field = WaveField();
  field.values[100] = std::numeric_limits<float>::quiet_NaN();
  field.values[2000] = std::numeric_limits<float>::infinity();
  field.values[3000] = -std::numeric_limits<float>::infinity();
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(80));
  EXPECT_EQ(model->training->nonFinite, 3u);
  EXPECT_LE(model->volume.high, 1.0);
  EXPECT_GT(model->quality->psnr, 18);
  for (const float parameter : model->parameters) {
    ASSERT_TRUE(std::isfinite(parameter));
  }
}

// Every cell of the volume holds a NaN, and still half of the voxels are known.
TEST(Trainer, LearnsVoxelsAmongNaNs)
{
  Field<float> field = WaveField();
  for (std::int64_t k = 0; k < field.data().voxels(); ++k) {
    const glm::i64vec3 at = inr::GridPlace(k, field.dims);
    if ((at.x + at.y + at.z) % 2 != 0) {
      field.values[static_cast<std::size_t>(k)] = NAN;
    }
  }
  EXPECT_GT(inr::TrainModel(field.data(), {}, Steps(150))->quality->psnr, 20);
}

TEST(Trainer, ConstantVolumesAreExact)
{
  Field<float> field = WaveField();
  std::fill(field.values.begin(), field.values.end(), 4.25f);
  field.values[7] = std::numeric_limits<float>::quiet_NaN();
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(50));
  EXPECT_EQ(model->training->steps, 0u);
  EXPECT_EQ(model->quality->maxError, 0.0);
  EXPECT_EQ(model->quality->psnr, HUGE_VAL);
  float value = 1;
  const glm::vec3 middle(0.5f);
  inr::MakeEvaluator(model)->evaluate(&middle, 1, &value);
  EXPECT_EQ(inr::ValueOf(model->volume, value), 4.25);
}

TEST(Trainer, RefusesAVolumeOfNaNs)
{
  Field<float> field = WaveField();
  std::fill(field.values.begin(), field.values.end(), NAN);
  EXPECT_THROW(inr::TrainModel(field.data(), {}, Steps(5)), inr::Error);
}

TEST(Trainer, ClaimsNoSsimWhereNoWindowIsKnownToBeWhole)
{
  Field<float> field = WaveField();
  std::fill(field.values.begin(), field.values.end(), NAN);
  field.values[7] = 1.0f;
  const inr::Quality quality = *inr::TrainModel(field.data(), {}, Steps(5))->quality;
  EXPECT_EQ(quality.maxError, 0.0);
  EXPECT_TRUE(std::isnan(quality.ssim));
}

// 1 / (high - low) is infinite there.
TEST(Trainer, TakesADenormalRange)
{
  const Field<double> field =
      WaveField<double>({24, 20, 17}, inr::ScalarType::Float64, -1e-310, 1e-310);
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(150));
  EXPECT_GT(model->quality->psnr, 20);
  EXPECT_LT(model->quality->psnr, 100);
  EXPECT_LT(model->quality->ssim, 1);
  EXPECT_GT(model->quality->maxError, 0);
}

TEST(Trainer, TakesAxesOfOneVoxel)
{
  for (const glm::i64vec3& dims : {glm::i64vec3(200, 150, 1), glm::i64vec3(1, 120, 130)}) {
    const Field<float> field = WaveField<float>(dims, inr::ScalarType::Float32, 0, 1);
    EXPECT_GT(inr::TrainModel(field.data(), {}, Steps(150))->quality->psnr, 20);
  }
}

TEST(Trainer, ProgressRisesAndEndsInMeasuring)
{
  const Field<float> field = WaveField();
  double last = 0;
  bool measured = false;
  inr::TrainModel(field.data(), {}, Steps(20), [&](const inr::TrainingProgress& progress) {
    EXPECT_GE(progress.fraction, last);
    EXPECT_LE(progress.fraction, 1.0);
    last = progress.fraction;
    measured = measured || progress.phase == inr::TrainingPhase::Measuring;
    return true;
  });
  EXPECT_TRUE(measured);
  EXPECT_GT(last, 0.9);
}

// A target of which most decibels are there after the first steps is as far away as before.
TEST(Trainer, ProgressToATargetIsThatOfItsSteps)
{
  inr::TrainingOptions options = Steps(0);
  options.targetPsnr = 18;
  options.plannedSteps = 2000;
  options.description = SmallDescription();
  options.storedAs = inr::ParameterType::Half;
  const auto expectSteps = [](const inr::TrainingProgress& progress) {
    if (progress.phase == inr::TrainingPhase::Training) {
      EXPECT_LT(std::abs(progress.fraction - 0.9 * static_cast<double>(progress.steps) / 2000),
                1e-6);
    }
    return true;
  };
  const inr::ModelPointer model = inr::TrainModel(WaveField().data(), {}, options, expectSteps);
  EXPECT_LT(model->training->steps, 2000u);
}

TEST(Trainer, CanBeStopped)
{
  const Field<float> field = WaveField();
  int calls = 0;
  try {
    inr::TrainModel(field.data(), {}, Steps(1000),
                    [&](const inr::TrainingProgress&) { return ++calls < 3; });
    FAIL() << "went on";
  } catch (const inr::Error& error) {
    EXPECT_EQ(error.code(), inr::ErrorCode::Cancelled);
    EXPECT_EQ(calls, 3);
  }
}

/// Seconds a step takes with it, on any machine of today.
inr::Description HugeDescription()
{
  inr::Description description = inr::ChooseDescription({24, 20, 17}, inr::ScalarType::Float32, 0);
  description.network.neurons = 512;
  description.network.hiddenLayers = 12;
  return description;
}

TEST(Trainer, EndsALongStepByTheClock)
{
  inr::TrainingOptions options;
  options.description = HugeDescription();
  options.timeLimit = 0.5;
  const auto start = std::chrono::steady_clock::now();
  try {
    inr::TrainModel(WaveField().data(), {}, options);
    FAIL() << "there is a faster machine now";
  } catch (const inr::Error& error) {
    EXPECT_NE(std::string(error.what()).find("TimeLimit"), std::string::npos) << error.what();
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(8));
}

TEST(Trainer, AsksWithinALongStep)
{
  inr::TrainingOptions options = Steps(1000);
  options.description = HugeDescription();
  const std::thread::id here = std::this_thread::get_id();
  std::uint64_t steps = 1;
  const auto stop = [&](const inr::TrainingProgress& progress) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    steps = progress.steps;
    return false;
  };
  EXPECT_THROW(inr::TrainModel(WaveField().data(), {}, options, stop), inr::Error);
  EXPECT_EQ(steps, 0u);
}

TEST(Trainer, RefusesToTrainForEverOrOnNothing)
{
  const Field<float> field = WaveField();
  EXPECT_THROW(inr::TrainModel(field.data(), {}, Steps(0)), inr::Error);
  inr::TrainingOptions negative = Steps(5);
  negative.timeLimit = -1;
  EXPECT_THROW(inr::TrainModel(field.data(), {}, negative), inr::Error);
  inr::VolumeData nothing = field.data();
  nothing.dims.y = 0;
  EXPECT_THROW(inr::TrainModel(nothing, {}, Steps(5)), inr::Error);
}

TEST(Trainer, TakesPowersOfTwoForMacroCells)
{
  const Field<float> field = WaveField();
  inr::TrainingOptions options = Steps(1);
  options.macroCellSize = 8;
  EXPECT_EQ(inr::TrainModel(field.data(), {}, options)->macroCells.dims, glm::i64vec3(3, 3, 3));
  for (const int edge : {12, -8, 1 << 30}) { // the last one no reader would take
    options.macroCellSize = edge;
    EXPECT_THROW(inr::TrainModel(field.data(), {}, options), inr::Error);
  }
}

// The observer is called in the first step already.
TEST(Trainer, FindsBeforeItTrainsWhatNoFileCanHold)
{
  const auto refuses = [](const auto& field, const inr::VolumeInfo& info) {
    bool trained = false;
    const auto observe = [&](const inr::TrainingProgress&) { return trained = true; };
    EXPECT_THROW(inr::TrainModel(field.data(), info, Steps(2), observe), inr::Error);
    EXPECT_FALSE(trained);
  };
  inr::VolumeInfo info;
  info.origin.y = NAN;
  refuses(WaveField(), info);
  info = {};
  info.direction[2] = info.direction[1];
  refuses(WaveField(), info);
  info = {};
  info.arrayName = std::string(5000, 'x');
  refuses(WaveField(), info);
  Field<double> wide = WaveField<double>({8, 8, 8}, inr::ScalarType::Float64, 0, 1);
  wide.values[0] = -1.7e308;
  wide.values[1] = 1.7e308;
  refuses(wide, {});
}

TEST(Trainer, EndsWhenItDiverges)
{
  inr::TrainingOptions options = Steps(1000000);
  options.description = inr::ChooseDescription({24, 20, 17}, inr::ScalarType::Float32, 0);
  options.description->network.activation = inr::Activation::Exponential;
  options.description->network.outputActivation = inr::Activation::Exponential;
  options.description->network.hiddenLayers = 5;
  try {
    inr::TrainModel(WaveField().data(), {}, options);
    FAIL() << "went on";
  } catch (const inr::Error& error) {
    EXPECT_NE(std::string(error.what()).find("diverged"), std::string::npos) << error.what();
  }
}

TEST(Trainer, EveryKernelLearns)
{
  const Field<float> field = WaveField();
  for (const std::string& kernel : UsableKernels()) {
    inr::TrainingOptions options = Steps(150);
    options.kernel = kernel;
    const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
    EXPECT_GT(model->quality->psnr, 20) << kernel;
    EXPECT_EQ(model->training->kernel, kernel);
  }
}

} // namespace test::trainer
