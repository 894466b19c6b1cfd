// SPDX-License-Identifier: BSD-3-Clause
//
// Trainings that are stopped and go on from their checkpoint.
#include "Core/Error.h"
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Descent/Optimiser.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/FieldReader.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <new>

namespace test::resume {

using inr::CheckpointEvent;

class Resume : public testing::Test
{
protected:
  inr::TrainingOptions options(std::uint64_t steps)
  {
    inr::TrainingOptions options = Steps(steps);
    options.description = SmallDescription();
    options.storedAs = inr::ParameterType::Half; // packing takes longer than these trainings
    options.checkpoint.path = this->Path;
    options.checkpoint.tell = [this](CheckpointEvent event, const std::string& text) {
      this->Events.push_back(event);
      this->Texts.push_back(text);
    };
    return options;
  }

  inr::ModelPointer train(const inr::TrainingOptions& options)
  {
    this->Events.clear();
    this->Texts.clear();
    return inr::TrainModel(this->Data.data(), {}, options);
  }

  inr::ModelPointer withoutCheckpoint(inr::TrainingOptions options)
  {
    options.checkpoint.path.clear();
    return this->train(options);
  }

  /// Trains until it has taken so many steps, then stops it; returns what it is told.
  std::string stopAfter(std::uint64_t steps, const inr::TrainingOptions& options)
  {
    try {
      inr::TrainModel(this->Data.data(), {}, options,
                      [&](const inr::TrainingProgress& now) { return now.steps < steps; });
      ADD_FAILURE() << "went on";
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::Cancelled);
      return error.what();
    }
    return "";
  }

  long count(CheckpointEvent event) const
  {
    return std::count(this->Events.begin(), this->Events.end(), event);
  }

  /// Writes the checkpoint again, with another state.
  template <typename Change> void change(const inr::Description& description, const Change& change)
  {
    const inr::CheckpointFile file(this->Path);
    const inr::Arena threads(1);
    inr::GradientDescent descent(description, 1, inr::ChooseInstructionSet(""), threads);
    file.load(descent.state());
    inr::TrainingState state = file.state();
    change(state);
    inr::WriteCheckpoint(this->Path, file.identity(), state, descent.state());
  }

  bool exists() const { return std::filesystem::exists(this->Path); }

  TemporaryFolder Folder;
  std::string Path = Folder.file("a.inr.checkpoint");
  Field<float> Data = WaveField();
  std::vector<CheckpointEvent> Events;
  std::vector<std::string> Texts;
};

TEST_F(Resume, GivesTheModelThatItWouldHaveGiven)
{
  const inr::ModelPointer whole = this->withoutCheckpoint(this->options(12));
  const std::string told = this->stopAfter(5, this->options(12));
  EXPECT_NE(told.find("5 steps are kept in '" + this->Path), std::string::npos) << told;
  EXPECT_EQ(this->count(CheckpointEvent::Written), 1);
  this->stopAfter(9, this->options(12));
  const inr::ModelPointer resumed = this->train(this->options(12));
  ASSERT_EQ(this->count(CheckpointEvent::Resumed), 1);
  EXPECT_NE(this->Texts[0].find("9 steps"), std::string::npos) << this->Texts[0];
  EXPECT_EQ(resumed->parameters, whole->parameters);
  EXPECT_EQ(resumed->training->steps, 12u);
  EXPECT_EQ(resumed->training->plannedSteps, whole->training->plannedSteps);
  EXPECT_EQ(resumed->quality->psnr, whole->quality->psnr);
}

TEST_F(Resume, KeepsTheStepsBeforeMemoryRanOut)
{
  try {
    inr::TrainModel(this->Data.data(), {}, this->options(12), [](const inr::TrainingProgress& now) {
      return now.steps < 5 ? true : throw std::bad_alloc();
    });
    FAIL() << "went on";
  } catch (const inr::Error& error) {
    EXPECT_EQ(error.code(), inr::ErrorCode::TooLarge);
    const std::string told = error.what();
    EXPECT_NE(told.find("not enough memory to train"), std::string::npos) << told;
    EXPECT_NE(told.find("5 steps are kept in '" + this->Path), std::string::npos) << told;
  }
  this->train(this->options(12));
  EXPECT_EQ(this->count(CheckpointEvent::Resumed), 1);
}

TEST_F(Resume, LeavesNothingWhereNothingIsWorthKeeping)
{
  inr::TrainingOptions options = this->options(1000);
  options.checkpoint.path.clear();
  EXPECT_NE(this->stopAfter(1, options).find("nothing was kept"), std::string::npos);
  this->train(this->options(3)); // done long before the first checkpoint is due
  EXPECT_FALSE(this->exists());
  EXPECT_TRUE(this->Events.empty());
}

// However short the training was: it was stopped.
TEST_F(Resume, KeepsAllStepsWhenItIsStoppedBehindThem)
{
  inr::TrainingOptions options = this->options(12);
  for (const double interval : {3600.0, 0.0}) { // then they are kept already
    options.checkpoint.interval = interval;
    const inr::ModelPointer whole = this->withoutCheckpoint(options);
    try {
      inr::TrainModel(this->Data.data(), {}, options, [](const inr::TrainingProgress& now) {
        return now.phase != inr::TrainingPhase::Measuring;
      });
      FAIL() << "went on";
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::Cancelled);
      const std::string told = error.what();
      EXPECT_NE(told.find("measuring the quality; its 12 steps are kept in '" + this->Path),
                std::string::npos)
          << told;
    }
    ASSERT_TRUE(this->exists());
    EXPECT_TRUE(inr::CheckpointFile(this->Path).state().finished);
    EXPECT_EQ(this->train(options)->parameters, whole->parameters);
    EXPECT_EQ(this->count(CheckpointEvent::Resumed), 1);
    EXPECT_EQ(this->count(CheckpointEvent::Written), 0);
    std::filesystem::remove(this->Path);
  }
}

TEST_F(Resume, WritesInIntervals)
{
  inr::TrainingOptions options = this->options(400);
  options.checkpoint.interval = 0.01;
  const inr::ModelPointer whole = this->train(options);
  // One on the way, or more: writing takes no more than a twentieth of the time.
  EXPECT_GE(this->count(CheckpointEvent::Written), 2);
  EXPECT_EQ(this->count(CheckpointEvent::Failed), 0);
  // The last one is of all steps: what is left is to measure.
  const inr::CheckpointFile file(this->Path);
  EXPECT_TRUE(file.state().finished);
  EXPECT_EQ(file.state().steps, 400u);
  const inr::ModelPointer again = this->train(options);
  EXPECT_EQ(again->parameters, whole->parameters);
  EXPECT_EQ(this->count(CheckpointEvent::Resumed), 1);
  EXPECT_EQ(this->count(CheckpointEvent::Written), 0);
}

TEST_F(Resume, EndsAtTheSameStepByQuality)
{
  inr::TrainingOptions options = this->options(5000);
  options.targetPsnr = 24;
  const inr::ModelPointer whole = this->withoutCheckpoint(options);
  EXPECT_LT(whole->training->steps, 5000u);
  options.checkpoint.interval = 0;
  this->stopAfter(150, options);
  const inr::ModelPointer resumed = this->train(options);
  EXPECT_EQ(resumed->training->steps, whole->training->steps);
  EXPECT_EQ(resumed->parameters, whole->parameters);
  EXPECT_EQ(this->train(options)->training->steps, whole->training->steps);
}

TEST_F(Resume, GivesTheModelThatTrainingFromPiecesWouldHaveGiven)
{
  const Field<float> field =
      WaveField<float>({128, 140, 153}, inr::ScalarType::Float32, -3, 5); // three pieces
  inr::TrainingOptions options = this->options(200);
  options.memoryLimit = std::int64_t{120} << 20;
  const auto trainFrom = [&](const inr::TrainingObserver& observer) {
    FieldReader<float> reader(field);
    return inr::TrainModel(reader, {}, options, observer);
  };
  options.checkpoint.path.clear();
  const inr::ModelPointer whole = trainFrom({});
  options.checkpoint.path = this->Path;
  // Pieces are being read again by then. The thread that reads them may see the 25th step a good
  // many steps later.
  EXPECT_THROW(trainFrom([](const inr::TrainingProgress& now) { return now.steps < 25; }),
               inr::Error);
  EXPECT_EQ(trainFrom({})->parameters, whole->parameters);
  EXPECT_EQ(this->count(CheckpointEvent::Resumed), 1);
  // It is of other samples than the volume in memory gives.
  inr::TrainModel(field.data(), {}, options);
  EXPECT_EQ(this->count(CheckpointEvent::Resumed), 1);
  EXPECT_EQ(this->count(CheckpointEvent::Ignored), 1);
}

TEST_F(Resume, CountsTheTimeBefore)
{
  inr::TrainingOptions options = this->options(0);
  options.timeLimit = 5;
  this->stopAfter(5, options);
  this->change(*options.description, [](inr::TrainingState& state) { state.seconds = 4.9; });
  double first = -1;
  inr::TrainModel(this->Data.data(), {}, options, [&](const inr::TrainingProgress& now) {
    first = first < 0 ? now.fraction : first;
    return true;
  });
  EXPECT_GT(first, 0.85);
  const inr::ModelPointer model = this->train(options);
  EXPECT_GE(model->training->seconds, 5);
  EXPECT_LT(model->training->seconds, 15);
  EXPECT_GE(model->training->steps, 5u);
  // Five steps in 4.9 s: the plan is made by that.
  EXPECT_LT(model->training->plannedSteps, 10 * model->training->steps + 10);
}

TEST_F(Resume, IgnoresWhatIsOfAnotherTrainingAndSaysWhy)
{
  this->stopAfter(3, this->options(6));
  const std::string kept = ReadBytes(this->Path);
  EXPECT_NE(kept.find(inr::OptimiserName), std::string::npos) << "one of another is taken up";
  const auto expectIgnored = [&](const inr::TrainingOptions& options, const std::string& words) {
    const inr::ModelPointer model = this->train(options);
    ASSERT_EQ(this->count(CheckpointEvent::Ignored), 1) << words;
    EXPECT_NE(this->Texts[0].find(words), std::string::npos) << this->Texts[0];
    EXPECT_NE(this->Texts[0].find(this->Path), std::string::npos) << this->Texts[0];
    EXPECT_EQ(model->parameters, this->withoutCheckpoint(options)->parameters)
        << "was used: " << words;
  };
  inr::TrainingOptions other = this->options(6);
  other.seed = 2;
  expectIgnored(other, "Seed is 1 there and 2 here");
  expectIgnored(this->options(7), "MaximumSteps is 6 there and 7 here");
  other = this->options(6);
  other.description->network.neurons = 32;
  expectIgnored(other, "the model is");
  other = this->options(6);
  other.start = this->withoutCheckpoint(this->options(1));
  expectIgnored(other, "the parameters to start from");
  const float before = this->Data.values[1234];
  this->Data.values[1234] = 7;
  expectIgnored(this->options(6), "the range of values");
  this->Data.values[1234] = before;
  std::reverse(this->Data.values.begin(), this->Data.values.end()); // the same range
  expectIgnored(this->options(6), "random voxels");
  EXPECT_EQ(ReadBytes(this->Path), kept);
}

TEST_F(Resume, IgnoresABrokenFile)
{
  this->stopAfter(3, this->options(6));
  std::string bytes = ReadBytes(this->Path);
  bytes[bytes.size() - 9] ^= 4;
  WriteBytes(this->Path, bytes);
  const inr::ModelPointer model = this->train(this->options(6));
  ASSERT_EQ(this->count(CheckpointEvent::Ignored), 1);
  EXPECT_NE(this->Texts[0].find("checksum"), std::string::npos) << this->Texts[0];
  EXPECT_EQ(model->parameters, this->withoutCheckpoint(this->options(6))->parameters);
}

TEST_F(Resume, KeepsWhatItCannotReadUnderAnotherName)
{
  this->stopAfter(3, this->options(6));
  std::string later = ReadBytes(this->Path);
  later[8] = 77; // the format's version
  std::string damaged = ReadBytes(this->Path);
  damaged.resize(damaged.size() / 2);
  int number = 0;
  for (const std::string& bytes : {later, damaged, std::string("notes of a year")}) {
    WriteBytes(this->Path, bytes);
    this->stopAfter(2, this->options(6));
    ++number;
    EXPECT_EQ(this->count(CheckpointEvent::Ignored), number);
    const std::string name = this->Path + ".other" + (number > 1 ? std::to_string(number) : "");
    EXPECT_EQ(ReadBytes(name), bytes) << this->Texts[0];
  }
}

TEST_F(Resume, GoesOnWithoutCheckpointsWhereThereIsNoOtherName)
{
  this->Path = Folder.file(std::string(250, 'n')); // ".other" at its end is too much for a name
  WriteBytes(this->Path, "notes of a year");
  inr::TrainingOptions options = this->options(3);
  options.checkpoint.interval = 0;
  EXPECT_EQ(this->train(options)->parameters,
            this->withoutCheckpoint(this->options(3))->parameters);
  EXPECT_EQ(this->count(CheckpointEvent::Failed), 1);
  EXPECT_EQ(ReadBytes(this->Path), "notes of a year");
}

TEST_F(Resume, KeepsTheCheckpointOfAnotherTrainingUnderAnotherName)
{
  inr::TrainingOptions other = this->options(6);
  std::vector<std::string> kept;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    other.seed = seed;
    this->stopAfter(3, other);
    kept.push_back(ReadBytes(this->Path));
  }
  EXPECT_EQ(ReadBytes(this->Path + ".other"), kept[0]);
  EXPECT_EQ(ReadBytes(this->Path + ".other2"), kept[1]);
  EXPECT_EQ(this->count(CheckpointEvent::Ignored), 2);
  std::filesystem::rename(this->Path + ".other", this->Path);
  other.seed = 1;
  const inr::ModelPointer whole = this->withoutCheckpoint(other);
  EXPECT_EQ(this->train(other)->parameters, whole->parameters);
  EXPECT_EQ(this->count(CheckpointEvent::Resumed), 1);
}

TEST_F(Resume, BeginsAnewWhenToldTo)
{
  this->stopAfter(3, this->options(6));
  inr::TrainingOptions options = this->options(6);
  options.checkpoint.resume = false;
  double seconds = this->train(options)->training->seconds;
  EXPECT_TRUE(this->Events.empty());
  EXPECT_GT(seconds, 0);
}

TEST_F(Resume, GoesOnWithoutACheckpointWhereNoneCanBeWritten)
{
  inr::TrainingOptions options = this->options(300);
  options.checkpoint.path = this->Folder.file("no/such/folder");
  options.checkpoint.interval = 0.01;
  EXPECT_EQ(this->train(options)->training->steps, 300u);
  EXPECT_EQ(this->count(CheckpointEvent::Failed), 1);
  EXPECT_EQ(this->Events.size(), 1u);
  EXPECT_NE(this->Texts[0].find("the training goes on"), std::string::npos) << this->Texts[0];
  EXPECT_NE(this->stopAfter(2, options).find("No such file"), std::string::npos);
}

TEST_F(Resume, DoesNotSayThatWhatIsGoneIsKept)
{
  const std::string folder = this->Folder.file("folder");
  std::filesystem::create_directory(folder);
  inr::TrainingOptions options = this->options(300);
  options.checkpoint.path = folder + "/checkpoint";
  options.checkpoint.interval = 0.01;
  std::string said;
  options.checkpoint.tell = [&](CheckpointEvent event, const std::string& text) {
    if (event == CheckpointEvent::Written) {
      std::filesystem::remove_all(folder);
    } else {
      said += text;
    }
  };
  EXPECT_EQ(this->train(options)->training->steps, 300u);
  EXPECT_NE(said.find("the training goes on, without a checkpoint"), std::string::npos) << said;

  std::filesystem::create_directory(folder);
  const std::string told = this->stopAfter(200, options);
  EXPECT_FALSE(std::filesystem::exists(folder)) << "there was no checkpoint";
  EXPECT_NE(told.find("; nothing was kept"), std::string::npos) << told;
}

TEST_F(Resume, ClearsAwayWhatAKilledProcessLeft)
{
  const std::string abandoned = this->Path + ".4194305.0.tmp"; // above the largest process number
  const std::string alive = this->Path + ".1.0.tmp";
  const std::string others = this->Path + ".my.tmp";
  for (const std::string& name : {abandoned, alive, others}) {
    WriteBytes(name, "half");
  }
  this->train(this->options(1));
  EXPECT_FALSE(std::filesystem::exists(abandoned));
  EXPECT_TRUE(std::filesystem::exists(alive));
  EXPECT_TRUE(std::filesystem::exists(others));
}

} // namespace test::resume
