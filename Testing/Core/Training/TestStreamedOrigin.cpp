// SPDX-License-Identifier: BSD-3-Clause
//
// Small differences of large numbers, in a training from pieces: as good as from memory.
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/Training/StreamingGroup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace test::streamed_origin {

/// Waves of 1000 steps from `offset` on.
template <class T> Field<T> Large(inr::ScalarType type, T offset, double step)
{
  Field<T> field = WaveField<T>({48, 40, 44}, type, 0, 1000);
  for (T& value : field.values) {
    value = offset + static_cast<T>(step * std::round(static_cast<double>(value)));
  }
  return field;
}

/// Doubles of this size are multiples of 1024.
Field<std::int64_t> LargeIntegers()
{
  return Large<std::int64_t>(inr::ScalarType::Int64, std::numeric_limits<std::int64_t>::min(), 1);
}

template <class T>
inr::ModelPointer TrainFromPieces(const Field<T>& field, const inr::TrainingOptions& options,
                                  const inr::TrainingObserver& observer = {})
{
  FieldReader<T> reader(field);
  return inr::TrainModel(reader, {}, options, observer);
}

template <class T> void ExpectAsGoodAsFromMemory(const Field<T>& field)
{
  const inr::TrainingOptions options = StreamedOptions(80);
  const inr::ModelPointer memory = inr::TrainModel(field.data(), {}, options);
  const inr::ModelPointer pieces = TrainFromPieces(field, options);
  EXPECT_GT(pieces->quality->psnr, memory->quality->psnr - 1);
}

TEST(StreamedOrigin, KeepsWhatADoubleRounds)
{
  ExpectAsGoodAsFromMemory(LargeIntegers());
  ExpectAsGoodAsFromMemory(
      Large<std::uint64_t>(inr::ScalarType::UInt64, std::uint64_t{1} << 63, 4));
}

template <class T> void ExpectAGroupAsGoodAsFromMemory(const Field<T>& field)
{
  const inr::TrainingOptions options = StreamedOptions(80);
  const inr::ModelPointer memory = inr::TrainModel(field.data(), {}, options);
  for (const Outcome& outcome : TrainTogether(3, options, {}, {}, field)) {
    ASSERT_TRUE(outcome.model) << outcome.error->what();
    EXPECT_GT(outcome.model->quality->psnr, memory->quality->psnr - 1);
  }
}

TEST(StreamedOrigin, IsTheSameInAllProcesses)
{
  ExpectAGroupAsGoodAsFromMemory(LargeIntegers());
  Field<double> field = Large<double>(inr::ScalarType::Float64, std::ldexp(1.0, 60), 256);
  const auto rest = static_cast<std::ptrdiff_t>(field.values.size() * 2 / 5);
  std::fill(field.values.begin(), field.values.begin() + rest, NAN); // all that rank 0 reads
  ExpectAGroupAsGoodAsFromMemory(field);
}

class StreamedOriginResumed : public testing::Test
{
protected:
  StreamedOriginResumed()
  {
    this->Options.checkpoint.path = this->Folder.file("a.checkpoint");
    this->Options.checkpoint.interval = 0;
    this->Options.checkpoint.tell = [this](inr::CheckpointEvent event, const std::string& text) {
      this->Ignored = event == inr::CheckpointEvent::Ignored ? text : this->Ignored;
    };
  }

  inr::ModelPointer trainWithoutCheckpoint() const
  {
    inr::TrainingOptions options = this->Options;
    options.checkpoint = {};
    return TrainFromPieces(this->Data, options);
  }

  void stopAfter(std::uint64_t steps)
  {
    EXPECT_THROW(
        TrainFromPieces(this->Data, this->Options,
                        [&](const inr::TrainingProgress& now) { return now.steps < steps; }),
        inr::Error);
  }

  TemporaryFolder Folder;
  inr::TrainingOptions Options = StreamedOptions(40);
  Field<std::int64_t> Data = LargeIntegers();
  std::string Ignored;
};

TEST_F(StreamedOriginResumed, IsThatOfBefore)
{
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  for (const std::uint64_t steps : {10u, 30u}) {
    this->stopAfter(steps);
  }
  bool surveyed = false;
  const inr::ModelPointer model =
      TrainFromPieces(this->Data, this->Options, [&](const inr::TrainingProgress& now) {
        surveyed |= now.phase == inr::TrainingPhase::Reading;
        return true;
      });
  EXPECT_FALSE(surveyed);
  EXPECT_EQ(this->Ignored, "");
  EXPECT_EQ(model->parameters, whole->parameters);
}

TEST_F(StreamedOriginResumed, IsThatOfBeforeInAGroup)
{
  inr::TrainingOptions options = this->Options;
  options.checkpoint = {};
  const std::vector<Outcome> whole = TrainTogether(2, options, {}, {}, this->Data);
  bool surveyed = false;
  const auto stop = [&](int rank, const inr::TrainingProgress& now) {
    if (rank == 0) { // its thread's alone
      surveyed = surveyed || now.phase == inr::TrainingPhase::Reading;
    }
    return now.steps < 20;
  };
  ExpectErrors(TrainTogether(2, this->Options, {}, stop, this->Data), "stopped");
  EXPECT_TRUE(std::exchange(surveyed, false));
  const auto watch = [&](int rank, const inr::TrainingProgress& now) {
    if (rank == 0) { // its thread's alone
      surveyed = surveyed || now.phase == inr::TrainingPhase::Reading;
    }
    return true;
  };
  const std::vector<Outcome> resumed = TrainTogether(2, this->Options, {}, watch, this->Data);
  EXPECT_FALSE(surveyed);
  EXPECT_EQ(resumed[1].model->parameters, whole[1].model->parameters);
}

// One whose samples had no origin, and had lost what makes them different.
TEST_F(StreamedOriginResumed, IsMissedInAnOlderCheckpoint)
{
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  this->stopAfter(10);
  const std::string& path = this->Options.checkpoint.path;
  const inr::CheckpointFile file(path);
  const inr::Arena threads(1);
  inr::GradientDescent descent(SmallDescription(), 1, inr::ChooseInstructionSet(""), threads);
  file.load(descent.state());
  inr::TrainingIdentity identity = file.identity();
  std::string& samples = identity.at("the samples, which MemoryLimit decides on,");
  const std::size_t origin = samples.find(" above -9.22337203685477");
  ASSERT_NE(origin, std::string::npos) << samples;
  samples.resize(origin);
  inr::WriteCheckpoint(path, identity, file.state(), descent.state());
  EXPECT_EQ(TrainFromPieces(this->Data, this->Options)->parameters, whole->parameters);
  EXPECT_NE(this->Ignored.find("blocks there and a pool of"), std::string::npos) << this->Ignored;
  EXPECT_NE(this->Ignored.find("e+18 here"), std::string::npos);
}

} // namespace test::streamed_origin
