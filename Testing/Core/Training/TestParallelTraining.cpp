// SPDX-License-Identifier: BSD-3-Clause
//
// Training by a group, here of threads, each of which holds a piece of the volume.
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Parallel/ParallelTraining.h"
#include "Core/Training/Parallel/PieceBatches.h"
#include "Core/Training/Quality/Quality.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"
#include "Testing/Core/Training/ThreadGroup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <optional>
#include <thread>

namespace test::parallel_training {

constexpr glm::i64vec3 Dims(26, 21, 17);

inr::VolumeInfo Info()
{
  inr::VolumeInfo info;
  info.dims = Dims;
  return info;
}

Field<float> Whole() { return WaveField<float>(Dims, inr::ScalarType::Float32, -1, 1); }

/// A copy of some of a field's voxels.
struct Piece
{
  Piece() = default;
  Piece(const Field<float>& whole, const glm::i64vec3& first, const glm::i64vec3& end)
      : First(first), Part{end - first, whole.type, {}}
  {
    for (std::int64_t z = first.z; z < end.z; ++z) {
      for (std::int64_t y = first.y; y < end.y; ++y) {
        for (std::int64_t x = first.x; x < end.x; ++x) {
          const std::int64_t k = x + whole.dims.x * (y + whole.dims.y * z);
          this->Part.values.push_back(whole.values[static_cast<std::size_t>(k)]);
        }
      }
    }
  }

  inr::VolumePiece data() const { return {this->Part.data(), this->First}; }

  glm::i64vec3 First{0};
  Field<float> Part{glm::i64vec3(0), inr::ScalarType::Float32, {}};
};

/// As ParaView cuts it: neighbours share a layer.
std::vector<Piece> Cut(const Field<float>& field, int count)
{
  const glm::i64vec3 d = field.dims;
  if (count == 1) {
    return {Piece(field, glm::i64vec3(0), d)};
  }
  if (count == 2) {
    return {Piece(field, glm::i64vec3(0), {9, d.y, d.z}), Piece(field, {8, 0, 0}, d)};
  }
  return {Piece(field, glm::i64vec3(0), {9, 13, d.z}), Piece(field, {8, 0, 0}, {d.x, 13, d.z}),
          Piece(field, {0, 12, 0}, {9, d.y, d.z}), Piece(field, {8, 12, 0}, d)};
}

/// All on the first: one process with a mini-batch that is `count` times as large.
std::vector<Piece> OnOne(const Field<float>& field, int count)
{
  std::vector<Piece> pieces(static_cast<std::size_t>(count));
  pieces[0] = Piece(field, glm::i64vec3(0), field.dims);
  return pieces;
}

inr::TrainingOptions Options(std::uint64_t steps)
{
  inr::TrainingOptions options = Steps(steps);
  options.description = SmallDescription();
  options.storedAs = inr::ParameterType::Half;
  options.threads = 1;
  return options;
}

using Watch = std::function<bool(int rank, const inr::TrainingProgress&)>;

/// What each process of the group gets, or what it is told.
struct Outcome
{
  inr::ModelPointer model;
  std::optional<inr::Error> error;
};

std::vector<Outcome> Train(const std::vector<Piece>& pieces, const inr::TrainingOptions& options,
                           const Watch& watch = {})
{
  const auto size = static_cast<int>(pieces.size());
  std::vector<Outcome> outcomes(pieces.size());
  InGroup(size, [&](const ThreadGroup& group) {
    const auto rank = static_cast<std::size_t>(group.rank());
    try {
      outcomes[rank].model = inr::TrainModel(
          pieces[rank].data(), Info(), options, group,
          [&](const inr::TrainingProgress& now) { return !watch || watch(group.rank(), now); });
    } catch (const inr::Error& error) {
      outcomes[rank].error = error;
    }
  });
  return outcomes;
}

void ExpectErrors(const std::vector<Outcome>& outcomes, inr::ErrorCode code,
                  const std::string& words)
{
  for (const Outcome& outcome : outcomes) {
    ASSERT_TRUE(outcome.error.has_value()) << "went on, instead of: " << words;
    EXPECT_EQ(outcome.error->code(), code);
    EXPECT_NE(std::string(outcome.error->what()).find(words), std::string::npos)
        << outcome.error->what();
  }
}

/// In an order of their own.
void Sort(std::vector<glm::vec3>& positions)
{
  std::sort(positions.begin(), positions.end(), [](const glm::vec3& a, const glm::vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
}

TEST(PieceBatches, AreTogetherTheSamplesOfOneProcess)
{
  const Field<float> field = Whole();
  const inr::InMemorySource source(field.data(), -1, 1);
  const inr::StratifiedBatches usual(source);
  for (const int count : {1, 2, 4}) {
    SCOPED_TRACE(count);
    std::vector<glm::vec3> expected(static_cast<std::size_t>(count) * inr::BatchSize);
    std::vector<float> values(expected.size());
    for (int batch = 0; batch < count; ++batch) {
      const std::int64_t first = batch * inr::BatchSize;
      usual.draw(77, static_cast<std::uint64_t>(5 * count + batch), 0, inr::BatchSize,
                 &expected[first], &values[first]);
    }
    std::vector<glm::vec3> found;
    std::mutex mutex;
    const std::vector<Piece> pieces = Cut(field, count);
    InGroup(count, [&](const ThreadGroup& group) {
      const inr::VolumePiece piece = pieces[static_cast<std::size_t>(group.rank())].data();
      const inr::VolumePart part(piece, Dims, group);
      inr::PieceBatches batches(part, -1, 1, count);
      batches.prepare({5, 100, 77}, inr::StopCheck());
      EXPECT_EQ(batches.total(), count * inr::BatchSize);
      std::vector<glm::vec3> positions(static_cast<std::size_t>(batches.count()));
      std::vector<float> targets(positions.size());
      std::vector<float> truth(positions.size());
      batches.draw(77, 5, 0, batches.count(), positions.data(), targets.data());
      source.sample(positions.data(), batches.count(), truth.data());
      EXPECT_EQ(targets, truth);
      // In proportion to its share of the voxels.
      const double share = static_cast<double>(part.voxels().count()) / (26 * 21 * 17);
      EXPECT_NEAR(static_cast<double>(batches.count()) / (count * inr::BatchSize), share, 0.05);
      const std::lock_guard<std::mutex> lock(mutex);
      found.insert(found.end(), positions.begin(), positions.end());
    });
    Sort(expected);
    Sort(found);
    EXPECT_EQ(found, expected);
  }
}

/// What the first moments hold of d loss / d parameter after the first step; the same in all
/// processes.
std::vector<float> FirstGradient(const std::vector<Piece>& pieces)
{
  const auto size = static_cast<int>(pieces.size());
  std::vector<std::vector<float>> found(pieces.size());
  InGroup(size, [&](const ThreadGroup& group) {
    const auto rank = static_cast<std::size_t>(group.rank());
    const inr::Arena arena(1);
    const inr::VolumePart part(pieces[rank].data(), Dims, group);
    inr::PieceBatches batches(part, -1, 1, size);
    inr::GradientDescent descent(SmallDescription(), 1, inr::ChooseInstructionSet(""), arena);
    descent.share(group);
    descent.step(batches);
    const inr::StateArray moments = descent.state()[1];
    const auto* const values = static_cast<const float*>(moments.data);
    found[rank].assign(values, values + moments.bytes / 4);
  });
  for (const std::vector<float>& other : found) {
    EXPECT_EQ(other, found[0]);
  }
  return found[0];
}

TEST(ParallelTraining, HasTheGradientOfOneProcessWithALargerBatch)
{
  const Field<float> field = Whole();
  for (const int count : {2, 4}) {
    const std::vector<float> expected = FirstGradient(OnOne(field, count));
    const std::vector<float> found = FirstGradient(Cut(field, count));
    ASSERT_EQ(found.size(), expected.size());
    double largest = 0;
    double difference = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      largest = std::max<double>(largest, std::abs(expected[k]));
      difference = std::max<double>(difference, std::abs(found[k] - expected[k]));
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(difference, 2e-6 * largest) << count;
  }
}

/// Few samples, for which rank 1 takes half a second longer than rank 0.
class LateOnRankOne : public inr::StratifiedBatches
{
public:
  LateOnRankOne(const inr::SampleSource& source, std::promise<void>& firstIsDone, int rank)
      : StratifiedBatches(source), FirstIsDone(firstIsDone), Rank(rank)
  {}

  std::int64_t count() const override { return 16; }
  void draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin, std::int64_t end,
            glm::vec3* positions, float* targets) const override
  {
    StratifiedBatches::draw(stream, step, begin, end, positions, targets);
    if (this->Rank == 0) {
      this->FirstIsDone.set_value();
    } else {
      this->FirstIsDone.get_future().wait();
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
  }

private:
  std::promise<void>& FirstIsDone;
  int Rank;
};

TEST(ParallelTraining, TellsWaitingFromExchanging)
{
  const Field<float> field = Whole();
  const inr::InMemorySource source(field.data(), -1, 1);
  std::promise<void> firstIsDone;
  inr::ExchangeTimes times[2];
  InGroup(2, [&](const ThreadGroup& group) {
    const inr::Arena arena(1);
    inr::GradientDescent descent(SmallDescription(), 1, inr::ChooseInstructionSet(""), arena);
    descent.share(group);
    LateOnRankOne batches(source, firstIsDone, group.rank());
    descent.step(batches);
    times[group.rank()] = descent.exchangeTimes();
  });
  EXPECT_GT(times[0].waiting, 0.25); // what is left to a busy machine
  EXPECT_LT(times[1].waiting, times[0].waiting);
  EXPECT_LT(times[0].exchanging, times[0].waiting);
}

TEST(ParallelTraining, GivesAllTheSameModelEveryTime)
{
  const Field<float> field = Whole();
  for (const int count : {1, 2, 4}) {
    SCOPED_TRACE(count);
    const std::vector<Outcome> first = Train(Cut(field, count), Options(60));
    const std::vector<Outcome> again = Train(Cut(field, count), Options(60));
    ASSERT_TRUE(first[0].model);
    for (std::size_t rank = 0; rank < first.size(); ++rank) {
      EXPECT_EQ(first[rank].model->parameters, first[0].model->parameters);
      EXPECT_EQ(again[rank].model->parameters, first[0].model->parameters);
      EXPECT_EQ(first[rank].model->quality->psnr, first[0].model->quality->psnr);
      const inr::TrainingRecord& record = first[rank].model->training.value();
      EXPECT_EQ(record.exchangeSeconds > 0, count > 1);
      EXPECT_EQ(record.waitingSeconds > 0, count > 1);
      EXPECT_LE(record.waitingSeconds + record.exchangeSeconds, record.seconds);
    }
    const inr::ModelPointer one = Train(OnOne(field, count), Options(60))[0].model;
    EXPECT_NEAR(first[0].model->quality->psnr, one->quality->psnr, 0.5);
    EXPECT_GT(first[0].model->quality->psnr, 16);
  }
}

TEST(ParallelTraining, OfOneIsTheUsualOne)
{
  const Field<float> field = Whole();
  const inr::ModelPointer usual = inr::TrainModel(field.data(), {}, Options(7));
  const inr::ModelPointer found = Train(Cut(field, 1), Options(7))[0].model;
  EXPECT_EQ(found->parameters, usual->parameters);
  EXPECT_EQ(found->quality->psnr, usual->quality->psnr);
  EXPECT_EQ(found->quality->ssim, usual->quality->ssim);
}

TEST(ParallelTraining, MeasuresTheWholeVolume)
{
  Field<float> field = Whole();
  field.values[4000] = NAN;
  inr::TrainingOptions options = Options(60);
  options.storedAs = inr::ParameterType::Quantised;
  const inr::ModelPointer model = Train(Cut(field, 4), options)[2].model;
  ASSERT_TRUE(model);
  const inr::DecodedReport truth = inr::MeasureQuality(*inr::MakeEvaluator(model), field.data(),
                                                       model->volume, 16, inr::Arena(), {});
  EXPECT_NEAR(model->quality->psnr, truth.quality.psnr, 1e-9);
  EXPECT_EQ(model->quality->maxError, truth.quality.maxError);
  EXPECT_NEAR(model->quality->ssim, truth.quality.ssim, 0.02); // within pieces only
  EXPECT_EQ(model->training->nonFinite, 1u);
  ASSERT_EQ(model->macroCells.ranges.size(), truth.macroCells.ranges.size());
  for (std::size_t k = 0; k < truth.macroCells.ranges.size(); ++k) {
    EXPECT_NEAR(model->macroCells.ranges[k].low, truth.macroCells.ranges[k].low, 1e-6);
    EXPECT_NEAR(model->macroCells.ranges[k].high, truth.macroCells.ranges[k].high, 1e-6);
  }
}

TEST(ParallelTraining, StopsForAllWhenOneIsStopped)
{
  const std::vector<Piece> pieces = Cut(Whole(), 4);
  for (const int who : {0, 2}) {
    const auto stop = [who](int rank, const inr::TrainingProgress& now) {
      return rank != who || now.steps < 3;
    };
    ExpectErrors(Train(pieces, Options(100000), stop), inr::ErrorCode::Cancelled, "stopped");
    const auto later = [who](int rank, const inr::TrainingProgress& now) {
      return rank != who || now.phase == inr::TrainingPhase::Training;
    };
    ExpectErrors(Train(pieces, Options(3), later), inr::ErrorCode::Cancelled, "stopped");
  }
  const auto byOneWithNothing = [](int rank, const inr::TrainingProgress& now) {
    return rank != 1 || now.phase == inr::TrainingPhase::Training;
  };
  ExpectErrors(Train(OnOne(Whole(), 2), Options(3), byOneWithNothing), inr::ErrorCode::Cancelled,
               "stopped");
}

TEST(ParallelTraining, StopsForAllByTheClockOfTheFirst)
{
  inr::TrainingOptions options = Options(0);
  options.timeLimit = 0.4;
  std::vector<Outcome> outcomes = Train(Cut(Whole(), 4), options);
  while (!outcomes[0].model && options.timeLimit < 100) { // not one step on a busy machine
    options.timeLimit *= 8;
    outcomes = Train(Cut(Whole(), 4), options);
  }
  for (const Outcome& outcome : outcomes) {
    ASSERT_TRUE(outcome.model) << outcome.error->what();
    EXPECT_EQ(outcome.model->training->steps, outcomes[0].model->training->steps);
    EXPECT_EQ(outcome.model->training->plannedSteps, outcomes[0].model->training->plannedSteps);
    EXPECT_EQ(outcome.model->parameters, outcomes[0].model->parameters);
  }
}

TEST(ParallelTraining, StopsForAllAtTheTargetQuality)
{
  inr::TrainingOptions options = Options(5000);
  options.targetPsnr = 22;
  const std::vector<Outcome> outcomes = Train(Cut(Whole(), 2), options);
  EXPECT_LT(outcomes[0].model->training->steps, 5000u);
  EXPECT_EQ(outcomes[1].model->training->steps, outcomes[0].model->training->steps);
  EXPECT_GT(outcomes[0].model->quality->psnr, 21);
}

TEST(ParallelTraining, GoesOnFromItsCheckpoint)
{
  const TemporaryFolder folder;
  const std::vector<Piece> pieces = Cut(Whole(), 2);
  const inr::ModelPointer whole = Train(pieces, Options(9))[0].model;
  inr::TrainingOptions options = Options(9);
  options.checkpoint.path = folder.file("a.checkpoint");
  const auto stop = [](int rank, const inr::TrainingProgress& now) {
    return rank != 1 || now.steps < 4;
  };
  const std::vector<Outcome> stopped = Train(pieces, options, stop);
  EXPECT_NE(std::string(stopped[0].error->what()).find("4 steps are kept"), std::string::npos);
  int fewest = 9;
  std::mutex mutex;
  const auto watch = [&](int, const inr::TrainingProgress& now) {
    const std::lock_guard<std::mutex> lock(mutex);
    fewest = std::min(fewest, static_cast<int>(now.steps));
    return true;
  };
  EXPECT_EQ(Train(pieces, options, watch)[1].model->parameters, whole->parameters);
  EXPECT_GE(fewest, 4); // which are told of again where the first step takes long
}

// Whoever ends first may take the others with it.
TEST(ParallelTraining, NobodyLeavesBeforeTheCheckpointIsThere)
{
  const TemporaryFolder folder;
  inr::TrainingOptions options = Options(1000);
  options.checkpoint.path = folder.file("a.checkpoint");
  const std::vector<Piece> pieces = Cut(Whole(), 4);
  InGroup(4, [&](const ThreadGroup& group) {
    const auto rank = static_cast<std::size_t>(group.rank());
    const auto watch = [](const inr::TrainingProgress& now) { return now.steps < 3; };
    EXPECT_THROW(inr::TrainModel(pieces[rank].data(), Info(), options, group, watch), inr::Error);
    EXPECT_TRUE(std::filesystem::exists(options.checkpoint.path)) << rank;
  });
}

TEST(ParallelTraining, RefusesPiecesThatDoNotFit)
{
  const Field<float> field = Whole();
  const Piece left(field, glm::i64vec3(0), {9, Dims.y, Dims.z});
  const Piece right(field, {8, 0, 0}, Dims);
  ExpectErrors(Train({left, Piece()}, Options(3)), inr::ErrorCode::InvalidArgument, "gaps");
  ExpectErrors(Train({left, Piece(field, {9, 0, 0}, Dims)}, Options(3)),
               inr::ErrorCode::InvalidArgument, "gaps");
  ExpectErrors(Train({left, Piece(field, {6, 0, 0}, Dims)}, Options(3)),
               inr::ErrorCode::InvalidArgument, "overlap");
  // The same twice, or none at all, is fine.
  EXPECT_TRUE(Train({left, Piece(), right, left}, Options(1))[3].model);
}

TEST(ParallelTraining, OfAConstantVolumeIsExact)
{
  Field<float> field = Whole();
  std::fill(field.values.begin(), field.values.end(), 4.0f);
  const std::vector<Outcome> outcomes = Train(Cut(field, 2), Options(3));
  EXPECT_EQ(outcomes[1].model->volume.low, 4.0);
  EXPECT_EQ(outcomes[1].model->training->steps, 0u);
}

} // namespace test::parallel_training
