// SPDX-License-Identifier: BSD-3-Clause
//
// The checkpoint's file: what was written comes back, and nothing else does.
#include "Core/Error.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <sys/resource.h>

namespace test::checkpoint {

const inr::TrainingIdentity Identity{{"Seed", "1"}, {"the array", R"("h\u00e9\"")"}};
const inr::TrainingState State{1234, 20000, 61.75, 38.5, true, 2};

/// Two arrays of different sizes, one of which is empty.
struct Arrays
{
  std::vector<float> values{1.5f, -2.25f, 1e-30f};
  std::vector<std::uint16_t> counts{7, 65535};

  inr::StateArrays list()
  {
    return {{"values", this->values.data(), 12},
            {"counts", this->counts.data(), 4},
            {"nothing", nullptr, 0}};
  }
};

class Checkpoint : public testing::Test
{
protected:
  Checkpoint()
  {
    this->Size = inr::WriteCheckpoint(this->Path, Identity, State, this->Written.list());
  }

  void expectRefused(const std::string& words, inr::ErrorCode code = inr::ErrorCode::Malformed)
  {
    Arrays arrays;
    arrays.values = {0, 0, 0};
    try {
      inr::CheckpointFile(this->Path).load(arrays.list());
      ADD_FAILURE() << "was taken, instead of: " << words;
    } catch (const inr::Error& error) {
      const std::string text = error.what();
      EXPECT_EQ(error.code(), code) << text;
      EXPECT_NE(text.find(words), std::string::npos) << text;
      EXPECT_NE(text.find(this->Path), std::string::npos) << text;
    }
    EXPECT_EQ(arrays.values, std::vector<float>(3)) << "half loaded";
  }

  TemporaryFolder Folder;
  std::string Path = Folder.file("a.checkpoint");
  Arrays Written;
  std::int64_t Size;
};

TEST_F(Checkpoint, ComesBackAsItWasWritten)
{
  const inr::CheckpointFile file(this->Path);
  EXPECT_EQ(file.identity(), Identity);
  EXPECT_EQ(file.state().steps, State.steps);
  EXPECT_EQ(file.state().plannedSteps, State.plannedSteps);
  EXPECT_EQ(file.state().seconds, State.seconds);
  EXPECT_EQ(file.state().psnr, State.psnr);
  EXPECT_TRUE(file.state().finished);
  EXPECT_EQ(file.state().anew, State.anew);
  Arrays read;
  read.values = {0, 0, 0};
  read.counts = {0, 0};
  file.load(read.list());
  EXPECT_EQ(read.values, this->Written.values);
  EXPECT_EQ(read.counts, this->Written.counts);
  EXPECT_EQ(this->Size, static_cast<std::int64_t>(std::filesystem::file_size(this->Path)));
}

TEST_F(Checkpoint, RefusesEveryTruncationAndABitFlippedAnywhere)
{
  const std::string whole = ReadBytes(this->Path);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    WriteBytes(this->Path, whole.substr(0, size));
    this->expectRefused("");
  }
  WriteBytes(this->Path, whole + '\0');
  this->expectRefused("bytes");
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    std::string broken = whole;
    broken[byte] = static_cast<char>(broken[byte] ^ (1 << byte % 8));
    WriteBytes(this->Path, broken);
    const bool version = byte >= 8 && byte < 12;
    this->expectRefused("", version ? inr::ErrorCode::Unsupported : inr::ErrorCode::Malformed);
  }
}

TEST_F(Checkpoint, HoldsASurvey)
{
  EXPECT_FALSE(inr::CheckpointFile(this->Path).hasSurvey());
  Arrays survey;
  survey.values = {7, 8, 9};
  this->Size =
      inr::WriteCheckpoint(this->Path, Identity, State, this->Written.list(), survey.list());
  EXPECT_EQ(this->Size, static_cast<std::int64_t>(std::filesystem::file_size(this->Path)));
  const inr::CheckpointFile file(this->Path);
  ASSERT_TRUE(file.hasSurvey());
  Arrays read;
  read.values = {0, 0, 0};
  file.loadSurvey(read.list());
  EXPECT_EQ(read.values, survey.values);
  file.load(read.list());
  EXPECT_EQ(read.values, this->Written.values);
  inr::StateArrays fewer = read.list();
  fewer.pop_back();
  EXPECT_THROW(file.loadSurvey(fewer), inr::Error);
}

// A survey is of no use without the training: what is broken anywhere is not loaded.
TEST_F(Checkpoint, RefusesTheSurveyOfABrokenFile)
{
  inr::WriteCheckpoint(this->Path, Identity, State, this->Written.list(), this->Written.list());
  const std::string whole = ReadBytes(this->Path);
  const auto expectRefused = [this](const std::string& bytes) {
    WriteBytes(this->Path, bytes);
    Arrays read;
    read.values = {0, 0, 0};
    EXPECT_THROW(inr::CheckpointFile(this->Path).loadSurvey(read.list()), inr::Error)
        << bytes.size();
    EXPECT_EQ(read.values, std::vector<float>(3));
  };
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    expectRefused(whole.substr(0, byte));
    std::string broken = whole;
    broken[byte] = static_cast<char>(broken[byte] ^ (1 << byte % 8));
    expectRefused(broken);
  }
}

TEST_F(Checkpoint, SaysWhatItIsNot)
{
  const std::string whole = ReadBytes(this->Path);
  WriteBytes(this->Path, "a text that somebody has named like that");
  this->expectRefused("not a checkpoint");
  std::string later = whole;
  later[8] = 3;
  WriteBytes(this->Path, later);
  this->expectRefused("version 3", inr::ErrorCode::Unsupported);
  std::filesystem::remove(this->Path);
  std::filesystem::create_directory(this->Path);
  this->expectRefused("directory", inr::ErrorCode::CannotRead);
}

/// A file with this header and the checksum that it ought to have.
std::string FileOf(const std::string& header)
{
  const auto append = [](std::string& bytes, std::uint32_t value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  std::string bytes = "INRtrain";
  append(bytes, 1);
  append(bytes, static_cast<std::uint32_t>(header.size()));
  bytes += header;
  append(bytes, inr::ContinueChecksum(0, bytes.data(), bytes.size()));
  return bytes;
}

TEST_F(Checkpoint, RefusesHeadersThatLie)
{
  const std::string rest = R"("planned_steps":0,"seconds":0,"psnr":0,"finished":false})";
  for (const std::string& header :
       {std::string(), std::string("{"), std::string("[]"), std::string("{}"),
        std::string(60000, '['), R"({"training":{},"steps":-1,)" + rest,
        R"({"training":{},"steps":"many",)" + rest, R"({"training":{},"steps":1e300,)" + rest,
        R"({"training":{"Seed":1},"steps":1,)" + rest, R"({"training":[],"steps":1,)" + rest}) {
    WriteBytes(this->Path, FileOf(header));
    EXPECT_THROW(inr::CheckpointFile file(this->Path), inr::Error) << header.substr(0, 60);
  }
  WriteBytes(this->Path, FileOf(R"({"training":{},"steps":1,)" + rest));
  this->expectRefused("bytes where its model needs"); // but for its arrays it is right
  std::string endless = FileOf("{}");
  std::memset(&endless[12], 0xFF, 4);
  WriteBytes(this->Path, endless);
  this->expectRefused("header would have 4294967295 bytes");
}

TEST_F(Checkpoint, RefusesArraysOfAnotherModel)
{
  std::vector<float> more(4);
  try {
    inr::CheckpointFile(this->Path).load({{"values", more.data(), 16}});
    FAIL();
  } catch (const inr::Error& error) {
    EXPECT_NE(std::string(error.what()).find("needs"), std::string::npos) << error.what();
  }
  std::vector<float> same(3);
  std::vector<std::uint16_t> counts(2);
  EXPECT_THROW(
      inr::CheckpointFile(this->Path)
          .load(
              {{"other", same.data(), 12}, {"counts", counts.data(), 4}, {"nothing", nullptr, 0}}),
      inr::Error);
  EXPECT_EQ(same, std::vector<float>(3));
}

TEST_F(Checkpoint, KeepsTheOldOneWhenTheDiskIsFull)
{
  struct rlimit before
  {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  std::vector<float> large(100000, 1.0f);
  signal(SIGXFSZ, SIG_IGN); // then writing fails, as on a full disk
  struct rlimit small = before;
  small.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(
      inr::WriteCheckpoint(this->Path, Identity, State, {{"values", large.data(), 400000}}),
      inr::Error);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  signal(SIGXFSZ, SIG_DFL);
  Arrays read;
  EXPECT_NO_THROW(inr::CheckpointFile(this->Path).load(read.list()));
  const std::filesystem::directory_iterator entries(this->Folder.Path);
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST_F(Checkpoint, TakesATrainingUpBitForBit)
{
  const Field<float> field = WaveField();
  const inr::InMemorySource source(field.data(), -1, 1);
  inr::StratifiedBatches batches(source);
  const inr::Arena threads(2);
  for (const std::string& kernel : UsableKernels()) {
    SCOPED_TRACE(kernel);
    const inr::InstructionSet set = inr::ChooseInstructionSet(kernel);
    inr::GradientDescent whole(SmallDescription(), 1, set, threads);
    inr::GradientDescent first(SmallDescription(), 1, set, threads);
    inr::GradientDescent second(SmallDescription(), 1, set, threads);
    for (inr::GradientDescent* descent : {&whole, &first, &second}) {
      descent->plan(9);
    }
    for (int step = 0; step < 9; ++step) {
      whole.step(batches);
    }
    for (int step = 0; step < 4; ++step) {
      first.step(batches);
    }
    inr::WriteCheckpoint(this->Path, Identity, {first.steps(), 9, 0, 0, false}, first.state());
    const inr::CheckpointFile file(this->Path);
    file.load(second.state());
    second.goOnAfter(file.state().steps);
    for (int step = 4; step < 9; ++step) {
      second.step(batches);
    }
    const inr::StateArrays expected = whole.state();
    const inr::StateArrays found = second.state();
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(
          std::memcmp(found[k].data, expected[k].data, static_cast<std::size_t>(expected[k].bytes)),
          0)
          << expected[k].name;
    }
  }
}

} // namespace test::checkpoint
