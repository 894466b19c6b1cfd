// SPDX-License-Identifier: BSD-3-Clause
//
// What each process of a group keeps of its first reading, for a training that goes on.
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Streaming/KeptSurvey.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/Training/StreamingGroup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

namespace test::kept_survey {

using inr::CheckpointEvent;

/// What all processes read, in voxels of the volume.
double VolumesRead(const std::vector<Outcome>& outcomes)
{
  double voxels = 0;
  for (const Outcome& outcome : outcomes) {
    voxels += static_cast<double>(outcome.voxelsRead);
  }
  return voxels / static_cast<double>(StreamedField().data().voxels());
}

class KeptSurvey : public testing::Test
{
protected:
  KeptSurvey()
  {
    this->Options.checkpoint.path = this->Path;
    this->Options.checkpoint.interval = 0;
    this->Options.checkpoint.tell = [this](CheckpointEvent event, const std::string&) {
      this->Kept += event == CheckpointEvent::SurveyKept ? 1 : 0;
      this->Failed += event == CheckpointEvent::Failed ? 1 : 0;
    };
  }

  std::vector<Outcome> train(const Watch& watch = {}, const Before& before = {})
  {
    this->Kept = 0;
    this->Failed = 0;
    this->Surveyed = false;
    return TrainTogether(
        this->Size, this->Options, before,
        [&](int rank, const inr::TrainingProgress& now) {
          this->Surveyed = this->Surveyed || now.phase == inr::TrainingPhase::Reading;
          return !watch || watch(rank, now);
        },
        this->Data);
  }

  void stopAfter(std::uint64_t steps)
  {
    ExpectErrors(this->train([steps](int rank, const inr::TrainingProgress& now) {
      return rank != 1 || now.steps < steps;
    }),
                 "stopped");
  }

  std::vector<Outcome> trainWithoutCheckpoint()
  {
    inr::TrainingOptions options = this->Options;
    options.checkpoint = {};
    return TrainTogether(this->Size, options, {}, {}, this->Data);
  }

  /// In all processes, to the last bit.
  void expectModelOf(const std::vector<Outcome>& other, const std::vector<Outcome>& outcomes)
  {
    for (std::size_t rank = 0; rank < outcomes.size(); ++rank) {
      const inr::ModelPointer& model = outcomes[rank].model;
      ASSERT_TRUE(model) << outcomes[rank].error->what();
      EXPECT_EQ(model->parameters, other[rank].model->parameters);
      EXPECT_EQ(model->volume.low, other[rank].model->volume.low);
      EXPECT_EQ(model->volume.high, other[rank].model->volume.high);
      EXPECT_EQ(model->quality->psnr, other[rank].model->quality->psnr);
    }
  }

  std::string file(int rank) const { return inr::SurveyPath(this->Path, rank); }

  TemporaryFolder Folder;
  std::string Path = Folder.file("a.inr.checkpoint");
  inr::TrainingOptions Options = StreamedOptions(40);
  int Size = 2;
  Field<float> Data = StreamedField();
  std::atomic<int> Kept{0};
  std::atomic<int> Failed{0};
  std::atomic<bool> Surveyed{false};
};

TEST_F(KeptSurvey, SparesAGroupASecondReading)
{
  for (const int size : {2, 5}) {
    SCOPED_TRACE(size);
    this->Size = size;
    const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
    this->stopAfter(3);
    EXPECT_TRUE(this->Surveyed);
    EXPECT_EQ(this->Kept, size);
    const std::vector<Outcome> resumed = this->train();
    this->expectModelOf(whole, resumed);
    EXPECT_FALSE(this->Surveyed);
    EXPECT_EQ(this->Kept, size);
    EXPECT_LT(VolumesRead(resumed), VolumesRead(whole) - 0.7); // some blocks are looked at
  }
}

// What has been read again until then is read again: the samples are those of the step.
TEST_F(KeptSurvey, FitsEveryCheckpointOfItsTraining)
{
  const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
  for (const std::uint64_t steps : {1u, 17u, 25u, 39u}) {
    this->stopAfter(steps);
    EXPECT_EQ(this->Surveyed, steps == 1);
  }
  this->expectModelOf(whole, this->train());
  EXPECT_FALSE(this->Surveyed);
}

// What has to be read again may be most of the volume: here five blocks, after one is looked at.
TEST_F(KeptSurvey, IsFollowedByReadingsThatCanBeStopped)
{
  this->stopAfter(39);
  bool stop = false;
  const std::vector<Outcome> stopped = this->train(
      [&](int rank, const inr::TrainingProgress&) { return rank != 1 || !stop; },
      [&](int rank, int reading) {
        if (rank == 1) {
          stop = reading >= 2;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(100)); // progress is told every 200
      });
  ExpectErrors(stopped, "stopped");
  EXPECT_LE(stopped[1].reads, 4);
  this->expectModelOf(this->trainWithoutCheckpoint(), this->train());
}

// Whoever started the processes may end all of them when one has ended.
TEST_F(KeptSurvey, IsFollowedByACheckpointBeforeAnyProcessEnds)
{
  this->Options.checkpoint.interval = 3600; // none but the one at the stop
  this->Size = 5;
  const std::vector<Outcome> stopped =
      this->train([](int, const inr::TrainingProgress& now) { return now.steps < 5; });
  ExpectErrors(stopped, "stopped");
  for (const Outcome& outcome : stopped) {
    EXPECT_TRUE(outcome.leftCheckpoint);
  }
}

TEST_F(KeptSurvey, IsReadAgainWhereAFileIsBrokenOrMissing)
{
  const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
  this->stopAfter(20);
  std::string bytes = ReadBytes(this->file(1));
  bytes[bytes.size() / 2] ^= 4;
  WriteBytes(this->file(1), bytes);
  this->expectModelOf(whole, this->train());
  EXPECT_TRUE(this->Surveyed);

  std::filesystem::remove(this->file(0));
  this->expectModelOf(whole, this->train());
  EXPECT_TRUE(this->Surveyed);
}

TEST_F(KeptSurvey, IsOfNoOtherTraining)
{
  this->stopAfter(20);
  for (const auto& change : {&inr::TrainingOptions::seed, &inr::TrainingOptions::maximumSteps}) {
    this->Options.*change += 1;
    const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
    this->expectModelOf(whole, this->train());
    EXPECT_TRUE(this->Surveyed);
  }
}

// What was read stays of use, for all that follows.
TEST_F(KeptSurvey, IsOfAnyKernel)
{
  this->stopAfter(10);
  this->Options.kernel = "baseline";
  const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
  for (const std::uint64_t steps : {10u, 20u}) {
    this->stopAfter(steps);
    EXPECT_FALSE(this->Surveyed);
  }
  this->expectModelOf(whole, this->train());
  EXPECT_FALSE(this->Surveyed);
}

TEST_F(KeptSurvey, IsReadAgainWhenTheDataHaveChanged)
{
  const auto middle = static_cast<std::ptrdiff_t>(this->Data.values.size() / 2);
  for (const std::ptrdiff_t first : {std::ptrdiff_t{0}, middle}) { // then in one process alone
    this->stopAfter(20);
    std::reverse(this->Data.values.begin() + first, this->Data.values.end()); // within their range
    const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
    this->expectModelOf(whole, this->train());
    EXPECT_TRUE(this->Surveyed);
  }
}

// As where processes are killed while they write, or a checkpoint is removed to begin anew: each
// file is right by itself, and the data differ in a place that nobody looks at, and in their range.
TEST_F(KeptSurvey, IsThatOfTheCheckpointInAllProcesses)
{
  const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
  float& last = this->Data.values.back();
  const float before = last;
  last = 100;
  this->stopAfter(5);
  const std::string other[] = {ReadBytes(this->file(0)), ReadBytes(this->file(1))};
  last = before;
  std::filesystem::remove(this->Path);
  this->stopAfter(20);
  EXPECT_TRUE(this->Surveyed);
  const std::string checkpoint = ReadBytes(this->Path);
  for (const int others : {1, 2}) {
    for (int rank = 0; rank < others; ++rank) {
      WriteBytes(this->file(rank), other[rank]);
    }
    WriteBytes(this->Path, checkpoint);
    this->expectModelOf(whole, this->train());
    EXPECT_TRUE(this->Surveyed);
  }
}

TEST_F(KeptSurvey, IsNotWorthAFileWhereReadingIsShort)
{
  this->Options.checkpoint.interval = 3600;
  this->stopAfter(20);
  EXPECT_EQ(this->Kept, 0);
  EXPECT_FALSE(std::filesystem::exists(this->file(0)));
  this->train();
  EXPECT_TRUE(this->Surveyed);
}

TEST_F(KeptSurvey, IsLeftAloneWhereNothingIsToBeResumed)
{
  this->stopAfter(20);
  this->Options.checkpoint.resume = false;
  this->train();
  EXPECT_TRUE(this->Surveyed);
}

TEST_F(KeptSurvey, SaysWhereItCannotBeWritten)
{
  std::filesystem::create_directory(this->file(1));
  const std::vector<Outcome> whole = this->trainWithoutCheckpoint();
  this->expectModelOf(whole, this->train());
  EXPECT_EQ(this->Kept, 1);
  EXPECT_EQ(this->Failed, 1);
}

TEST(Surveys, OfAllProcessesAreRemovedAndNothingElse)
{
  const TemporaryFolder folder;
  const std::vector<std::string> stay = {"a.checkpoint", "a.checkpoint.rank", "a.checkpoint.rank1x",
                                         "b.checkpoint.rank0"};
  for (const std::string& name : stay) {
    WriteBytes(folder.file(name), "");
  }
  WriteBytes(folder.file("a.checkpoint.rank0"), "");
  WriteBytes(folder.file("a.checkpoint.rank12"), "");
  inr::RemoveSurveys(folder.file("a.checkpoint"));
  for (const std::string& name : stay) {
    EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.checkpoint.rank0")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.checkpoint.rank12")));
  inr::RemoveSurveys(folder.file("nowhere/a.checkpoint"));
}

} // namespace test::kept_survey
