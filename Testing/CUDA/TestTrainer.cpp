// SPDX-License-Identifier: BSD-3-Clause
//
// Whole trainings by the GPU's trainer, run on the host: beside the CPU's, and from wherever the
// samples come.
#include "Testing/CUDA/LazyMachine.h"
#include "Testing/CUDA/TrainSetup.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/Training/FieldReader.h"

namespace test::trainer {

using inr::TrainingPipeline;

inr::TrainingOptions With(std::shared_ptr<const inr::TrainingAccelerator> accelerator,
                          std::uint64_t steps)
{
  inr::TrainingOptions options = Steps(steps);
  options.description = SmallDescription();
  options.description->grid.features = 2;
  options.storedAs = inr::ParameterType::Half;
  options.acceleration.accelerator = std::move(accelerator);
  options.acceleration.tell = [](inr::AccelerationEvent, const std::string& text) {
    ADD_FAILURE() << text;
  };
  return options;
}

/// Bytes that leave no room for a volume beside such a training.
std::int64_t TightMemory(const inr::TrainingOptions& options)
{
  const inr::TrainingTask task{*options.description, inr::BatchSize, 0, std::nullopt};
  return inr::cuda::TrainingPlan(task, std::numeric_limits<std::int64_t>::max()).bytes;
}

TEST(Trainer, LearnsAsWellAsTheCpu)
{
  const Field<float> field = WaveField();
  const inr::TrainingOptions options = With(std::make_shared<EmulatedTrainer>(), 90);
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  const inr::ModelPointer cpu = inr::TrainModel(field.data(), {}, With(nullptr, 90));
  EXPECT_EQ(model->training->backend, "CUDA, emulated");
  EXPECT_EQ(model->training->kernel, "cuda float32");
  EXPECT_EQ(model->training->steps, 90u);
  EXPECT_GT(cpu->quality->psnr, 25);
  EXPECT_NEAR(model->quality->psnr, cpu->quality->psnr, 0.1);
}

TEST(Trainer, GivesTheSameFromDeviceAndHostMemory)
{
  const Field<std::int16_t> field =
      WaveField<std::int16_t>({12, 10, 9}, inr::ScalarType::Int16, -900, 800);
  const inr::ModelPointer there =
      inr::TrainModel(field.data(), {}, With(std::make_shared<EmulatedTrainer>(), 5));
  EXPECT_EQ(there->training->pipeline, TrainingPipeline::DeviceMemory);
  const std::int64_t tight = TightMemory(With(nullptr, 5));
  const inr::ModelPointer here =
      inr::TrainModel(field.data(), {}, With(std::make_shared<EmulatedTrainer>(tight), 5));
  EXPECT_EQ(here->training->pipeline, TrainingPipeline::HostMemory);
  EXPECT_EQ(here->parameters, there->parameters);
  // On a machine that does everything as late as it may.
  using Lazy = TrainerOn<LazyMachine>;
  for (const std::int64_t memory : {tight, std::numeric_limits<std::int64_t>::max()}) {
    const inr::ModelPointer lazy =
        inr::TrainModel(field.data(), {}, With(std::make_shared<Lazy>(memory), 5));
    EXPECT_EQ(lazy->parameters, there->parameters);
  }
}

TEST(Trainer, TakesSamplesOfAVolumeInPieces)
{
  const Field<float> field = WaveField();
  const auto train = [&](std::shared_ptr<const inr::TrainingAccelerator> accelerator) {
    FieldReader<float> reader(field);
    inr::TrainingOptions options = With(std::move(accelerator), 20);
    options.memoryLimit = std::int64_t{256} << 20;
    return inr::TrainModel(reader, {}, options);
  };
  const inr::ModelPointer model = train(std::make_shared<TrainerOn<LazyMachine>>());
  EXPECT_EQ(model->training->pipeline, TrainingPipeline::Storage);
  EXPECT_EQ(model->training->backend, "CUDA, emulated");
  EXPECT_NEAR(model->quality->psnr, train(nullptr)->quality->psnr, 0.3);
}

TEST(Trainer, GoesOnFromItsCheckpoint)
{
  const Field<float> field = WaveField();
  const TemporaryFolder folder;
  inr::TrainingOptions options = With(std::make_shared<EmulatedTrainer>(), 10);
  const inr::ModelPointer whole = inr::TrainModel(field.data(), {}, options);
  options.checkpoint.path = folder.file("a.inr.checkpoint");
  EXPECT_THROW(inr::TrainModel(field.data(), {}, options,
                               [](const inr::TrainingProgress& now) { return now.steps < 4; }),
               inr::Error);
  int resumed = 0;
  options.checkpoint.tell = [&](inr::CheckpointEvent event, const std::string&) {
    resumed += event == inr::CheckpointEvent::Resumed ? 1 : 0;
  };
  EXPECT_EQ(inr::TrainModel(field.data(), {}, options)->parameters, whole->parameters);
  EXPECT_EQ(resumed, 1);
}

TEST(Trainer, WithoutMemoryTheCpuTrains)
{
  const Field<float> field = WaveField();
  inr::TrainingOptions options = With(std::make_shared<EmulatedTrainer>(1 << 20), 3);
  std::vector<std::string> told;
  options.acceleration.tell = [&](inr::AccelerationEvent event, const std::string& text) {
    EXPECT_EQ(event, inr::AccelerationEvent::NotUsed);
    told.push_back(text);
  };
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  EXPECT_EQ(model->training->backend.substr(0, 4), "CPU ");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("of the GPU's memory, and 1 MiB are to be had"), std::string::npos)
      << told[0];
}

/// On this machine's GPU, where there is one.
TEST(Trainer, OfThisMachineLearnsAsWellAsTheCpu)
{
  const inr::cuda::FoundTrainer found = inr::cuda::FindTrainer(0);
  if (!found.accelerator) {
    GTEST_SKIP() << found.reason;
  }
  const Field<float> field = WaveField<float>({64, 60, 50}, inr::ScalarType::Float32, -1, 1);
  const inr::ModelPointer cpu = inr::TrainModel(field.data(), {}, With(nullptr, 500));
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, With(found.accelerator, 500));
  EXPECT_EQ(model->training->backend, found.accelerator->name());
  EXPECT_EQ(model->training->pipeline, TrainingPipeline::DeviceMemory);
  // The CPU's own kernels, which round differently, are up to 0.5 dB apart after so few steps.
  EXPECT_NEAR(model->quality->psnr, cpu->quality->psnr, 0.6);
  // Twice the same, bit for bit.
  const inr::ModelPointer again = inr::TrainModel(field.data(), {}, With(found.accelerator, 500));
  EXPECT_EQ(again->parameters, model->parameters);
}

} // namespace test::trainer
