// SPDX-License-Identifier: BSD-3-Clause
//
// Training from pieces against training from memory.
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Training/Quality/PsnrEstimate.h"
#include "Core/Training/Quality/Quality.h"
#include "Core/Training/Streaming/StreamBudget.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/FieldReader.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <chrono>
#include <new>
#include <thread>

namespace test::streamed_training {

constexpr std::int64_t MiB = std::int64_t{1} << 20;

/// Blocks of 4 MiB are the smallest: three of these.
const Field<float>& LargeField()
{
  static const auto* const field =
      new Field<float>(WaveField<float>({128, 140, 153}, inr::ScalarType::Float32, -3, 5));
  return *field;
}

inr::TrainingOptions Options(std::uint64_t steps)
{
  inr::TrainingOptions options = Steps(steps);
  options.description = SmallDescription();
  options.memoryLimit = 120 * MiB;
  return options;
}

TEST(StreamedTraining, IsAsGoodAsTrainingFromMemory)
{
  FieldReader<float> reader(LargeField());
  inr::TrainingOptions options = Options(300);
  const inr::ModelPointer whole = inr::TrainModel(LargeField().data(), {}, options);
  const inr::ModelPointer pieces = inr::TrainModel(reader, {}, options);
  EXPECT_EQ(pieces->training->steps, 300u);
  EXPECT_EQ(pieces->volume.low, whole->volume.low);
  EXPECT_EQ(pieces->volume.high, whole->volume.high);
  EXPECT_GT(pieces->quality->psnr, whole->quality->psnr - 0.3);
  EXPECT_EQ(pieces->quality->sampledVoxels, 0u);
  EXPECT_EQ(pieces->macroCells.provenance, inr::MacroCellProvenance::Decoded);
  EXPECT_LE(4 * reader.largest, 6 * MiB);
  EXPECT_LE(reader.voxelsRead, 3 * LargeField().data().voxels());
  EXPECT_GT(reader.voxelsRead, 2.5 * LargeField().data().voxels()); // read again, and measured
}

/// What anybody measures who decodes the model.
inr::DecodedReport Measured(const inr::ModelPointer& model)
{
  return inr::MeasureQuality(*inr::MakeEvaluator(model), LargeField().data(), model->volume, 16,
                             inr::Arena(), {});
}

TEST(StreamedTraining, SaysTheQualityOfTheModelThatItGives)
{
  FieldReader<float> reader(LargeField());
  const inr::ModelPointer model = inr::TrainModel(reader, {}, Options(30));
  const inr::DecodedReport report = Measured(model);
  EXPECT_NEAR(model->quality->psnr, report.quality.psnr, 1e-6);
  EXPECT_NEAR(model->quality->maxError, report.quality.maxError, 1e-6);
  EXPECT_NEAR(model->quality->ssim, report.quality.ssim, 0.01); // within blocks only
  for (std::size_t k = 0; k < report.macroCells.ranges.size(); ++k) {
    EXPECT_NEAR(model->macroCells.ranges[k].low, report.macroCells.ranges[k].low, 1e-6);
    EXPECT_NEAR(model->macroCells.ranges[k].high, report.macroCells.ranges[k].high, 1e-6);
  }
}

TEST(StreamedTraining, MeasuresBarsWhereVoxelsAreTooMany)
{
  FieldReader<float> reader(LargeField());
  inr::TrainingOptions options = Options(60);
  options.measuredVoxels = std::int64_t{1} << 19; // 4 bars
  const inr::ModelPointer model = inr::TrainModel(reader, {}, options);
  const inr::DecodedReport report = Measured(model);
  EXPECT_NEAR(static_cast<double>(model->quality->sampledVoxels), 1 << 19, 1 << 17);
  EXPECT_NEAR(model->quality->psnr, report.quality.psnr, 1.0);
  EXPECT_NEAR(model->quality->ssim, report.quality.ssim, 0.05);
  EXPECT_LE(model->quality->maxError, report.quality.maxError);
  EXPECT_GT(model->quality->maxError, 0.5 * report.quality.maxError);
  EXPECT_EQ(model->macroCells.provenance, inr::MacroCellProvenance::Training);
  const double range = model->volume.high - model->volume.low;
  const double error = report.quality.maxError / range;
  const double found = model->quality->maxError / range;
  for (std::size_t k = 0; k < report.macroCells.ranges.size(); ++k) {
    const inr::ValueRange& decoded = report.macroCells.ranges[k];
    const inr::ValueRange& guessed = model->macroCells.ranges[k];
    EXPECT_LE(guessed.low, decoded.low);
    EXPECT_GE(guessed.high, decoded.high);
    EXPECT_GE(guessed.high - guessed.low, 2 * found - 1e-6);
    EXPECT_LT(guessed.high - guessed.low, decoded.high - decoded.low + 4 * error + 1e-6);
  }
}

TEST(StreamedTraining, DependsNeitherOnThreadsNorOnTheSpeedOfReading)
{
  FieldReader<float> fast(LargeField());
  inr::TrainingOptions options = Options(20);
  options.threads = 1;
  const inr::ModelPointer one = inr::TrainModel(fast, {}, options);
  FieldReader<float> slow(LargeField());
  slow.before = [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(60)); };
  options.threads = 3;
  const inr::ModelPointer three = inr::TrainModel(slow, {}, options);
  EXPECT_EQ(one->parameters, three->parameters);
  EXPECT_EQ(one->quality->psnr, three->quality->psnr);
}

// Callbacks and readings come on the thread that asked, progress rises, and all phases are told.
TEST(StreamedTraining, KeepsToTheCallersThread)
{
  const std::thread::id here = std::this_thread::get_id();
  FieldReader<float> reader(LargeField());
  reader.before = [&](int) { EXPECT_EQ(std::this_thread::get_id(), here); };
  double last = 0;
  std::array<int, 3> phases{};
  inr::TrainModel(reader, {}, Options(40), [&](const inr::TrainingProgress& progress) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    EXPECT_GE(progress.fraction, last);
    last = progress.fraction;
    ++phases.at(static_cast<std::size_t>(progress.phase));
    return true;
  });
  EXPECT_GT(*std::min_element(phases.begin(), phases.end()), 0);
  EXPECT_LE(last, 1.0);
}

void ExpectError(inr::VolumeReader& reader, const inr::TrainingOptions& options,
                 const std::string& text, const inr::TrainingObserver& observer = {})
{
  try {
    inr::TrainModel(reader, {}, options, observer);
    ADD_FAILURE() << "no error";
  } catch (const inr::Error& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(StreamedTraining, StopsWhenItIsToldToInEveryPhase)
{
  for (const inr::TrainingPhase phase :
       {inr::TrainingPhase::Reading, inr::TrainingPhase::Training, inr::TrainingPhase::Measuring}) {
    FieldReader<float> reader(LargeField());
    ExpectError(reader, Options(40), "stopped",
                [&](const inr::TrainingProgress& progress) { return progress.phase != phase; });
  }
}

TEST(StreamedTraining, HandsOnWhatTheReaderSaysWheneverItFails)
{
  for (const int failing : {2, 6, 10}) { // while surveying, training and measuring
    FieldReader<float> reader(LargeField());
    reader.before = [&](int number) {
      if (number == failing) {
        throw inr::Error(inr::ErrorCode::CannotRead, "the disk is on fire");
      }
    };
    ExpectError(reader, Options(40), "on fire");
  }
}

TEST(StreamedTraining, SaysWhatToDoWhereTheReaderHasNoMemory)
{
  for (const int failing : {2, 6, 10}) { // while surveying, training and measuring
    FieldReader<float> reader(LargeField());
    reader.before = [&](int number) {
      if (number == failing) {
        throw std::bad_alloc();
      }
    };
    ExpectError(reader, Options(40), "not enough memory to read the data");
  }
}

TEST(StreamedTraining, SaysWhenTheDataChange)
{
  for (const float outside : {7.5f, -7.5f}) {
    Field<float> field = LargeField();
    FieldReader<float> reader(field);
    reader.before = [&](int number) {
      if (number == 5) { // the first reading of all four blocks is over
        std::fill(field.values.begin(), field.values.end(), outside);
      }
    };
    ExpectError(reader, Options(200), "the data changed while they were read");
  }
}

/// Before the second piece is read for the quality.
void ExpectChangeIsSeenInMeasuring(Field<float> field, std::int64_t measuredVoxels,
                                   const std::function<void(std::vector<float>&)>& change)
{
  FieldReader<float> reader(field);
  inr::TrainingOptions options = Options(10);
  options.measuredVoxels = measuredVoxels;
  options.storedAs = inr::ParameterType::Half; // packing takes longer than this training
  bool measuring = false;
  reader.before = [&](int) {
    if (measuring) {
      change(field.values);
    }
  };
  ExpectError(reader, options, "the data changed", [&](const inr::TrainingProgress& progress) {
    measuring = progress.phase == inr::TrainingPhase::Measuring;
    return true;
  });
}

constexpr std::int64_t AllVoxels = std::int64_t{1} << 26;
constexpr std::int64_t FourBars = std::int64_t{1} << 19;

TEST(StreamedTraining, SaysWhenTheDataChangeWhileTheyAreMeasured)
{
  for (const std::int64_t voxels : {AllVoxels, FourBars}) {
    for (const float other : {0.5f, NAN}) {
      ExpectChangeIsSeenInMeasuring(LargeField(), voxels, [other](std::vector<float>& values) {
        std::fill(values.begin(), values.end(), other);
      });
    }
  }
}

/// Those that neither are random voxels whose values are compared nor lie beside one.
std::vector<bool> UncomparedVoxels()
{
  const glm::i64vec3 dims = LargeField().dims;
  std::vector<bool> uncompared(LargeField().values.size(), true);
  for (const glm::vec3& position :
       inr::PsnrEstimate::positions(dims, Options(1).seed, inr::PsnrEstimate::StoringVoxels)) {
    const glm::i64vec3 voxel(glm::dvec3(position) * glm::dvec3(dims));
    for (std::int64_t k = 0; k < 27; ++k) {
      const glm::i64vec3 near =
          glm::clamp(voxel + glm::i64vec3(k % 3, k / 3 % 3, k / 9) - std::int64_t{1},
                     glm::i64vec3(0), dims - std::int64_t{1});
      uncompared[static_cast<std::size_t>(near.x + dims.x * (near.y + dims.y * near.z))] = false;
    }
  }
  return uncompared;
}

TEST(StreamedTraining, SaysWhenMoreOrFewerVoxelsAreFiniteThanBefore)
{
  const std::vector<bool> uncompared = UncomparedVoxels();
  const auto set = [&](std::vector<float>& values, float value) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = uncompared[k] ? value : values[k];
    }
  };
  const auto toNaN = [&](std::vector<float>& values) { set(values, NAN); };
  ExpectChangeIsSeenInMeasuring(LargeField(), FourBars, toNaN);
  Field<float> field = LargeField();
  toNaN(field.values);
  ExpectChangeIsSeenInMeasuring(field, AllVoxels,
                                [&](std::vector<float>& values) { set(values, 0.5f); });
}

TEST(StreamedTraining, SaysHowMuchMemoryAModelNeeds)
{
  FieldReader<float> reader(LargeField());
  inr::TrainingOptions options = Options(10);
  options.description->grid.log2HashmapSize = 19;
  options.description->grid.levels = 16;
  ExpectError(reader, options, "raise it or ask for a smaller model");
  options = Options(10);
  options.memoryLimit = 30 * MiB;
  ExpectError(reader, options, "raise it, as the smallest model takes too much");
}

TEST(StreamedTraining, SaysWhereMacroCellsTakeTooMuchMemory)
{
  inr::VolumeInfo info;
  info.dims = glm::i64vec3(1024);
  info.type = inr::ScalarType::Float32;
  inr::TrainingOptions options;
  options.memoryLimit = 1024 * MiB;
  int processes = 1;
  const auto problem = [&](int edge) -> std::string {
    options.macroCellSize = edge;
    try {
      inr::PlanStream(info, options, 4, processes);
    } catch (const inr::Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem(0), "");
  EXPECT_EQ(problem(8), "");
  EXPECT_NE(problem(2).find("macro-cells of 2 voxels"), std::string::npos) << problem(2);
  EXPECT_NE(problem(2).find("choose a larger MacroCellSize"), std::string::npos);
  processes = 4;
  EXPECT_NE(problem(2).find("in each process and its share of the MemoryLimit"), std::string::npos)
      << problem(2);
  EXPECT_NE(problem(1).find("choose larger ones"), std::string::npos) << problem(1);
}

TEST(StreamedTraining, FindsADefaultModelForEveryLimitThatHasRoomForOne)
{
  inr::VolumeInfo info;
  info.dims = glm::i64vec3(400, 300, 200);
  info.type = inr::ScalarType::Float32;
  inr::TrainingOptions options;
  int fitting = 0;
  for (std::int64_t limit = 90; limit < 200; ++limit) {
    options.memoryLimit = limit * MiB;
    try {
      inr::PlanStream(info, options, 4, 1);
      ++fitting;
    } catch (const inr::Error& error) {
      EXPECT_NE(std::string(error.what()).find("the smallest model takes too much"),
                std::string::npos)
          << limit << " MiB: " << error.what();
    }
  }
  EXPECT_GT(fitting, 70);
}

TEST(StreamedTraining, MakesTheDefaultModelFit)
{
  FieldReader<float> reader(LargeField());
  inr::TrainingOptions options = Options(2);
  options.description.reset();
  options.storedAs = inr::ParameterType::Half;
  const inr::ModelPointer model = inr::TrainModel(reader, {}, options);
  EXPECT_LT(model->parameters.size(), 120 * MiB / 2 / 19);
  options.memoryLimit = 2048 * MiB;
  EXPECT_EQ(inr::TrainModel(reader, {}, options)->description,
            inr::ChooseDescription(LargeField().dims, inr::ScalarType::Float32, 0,
                                   inr::ParameterType::Half));
}

TEST(StreamedTraining, OfAConstantVolumeIsExact)
{
  Field<float> field{{40, 30, 20}, inr::ScalarType::Float32, std::vector<float>(24000, 4.5f)};
  FieldReader<float> reader(field);
  const inr::ModelPointer model = inr::TrainModel(reader, {}, Options(10));
  EXPECT_EQ(model->volume.low, 4.5);
  EXPECT_EQ(model->quality->maxError, 0.0);
  EXPECT_EQ(model->training->steps, 0u);
}

// NaNs are no targets, wherever the borders of blocks are.
TEST(StreamedTraining, LeavesOutWhatIsNotFinite)
{
  Field<float> field = LargeField();
  for (std::size_t k = 0; k < field.values.size(); k += 7) {
    field.values[k] = NAN;
  }
  FieldReader<float> reader(field);
  const inr::ModelPointer model = inr::TrainModel(reader, {}, Options(60));
  const inr::ModelPointer whole = inr::TrainModel(field.data(), {}, Options(60));
  EXPECT_EQ(model->training->nonFinite, whole->training->nonFinite);
  EXPECT_GT(model->quality->psnr, whole->quality->psnr - 0.3);
}

} // namespace test::streamed_training
