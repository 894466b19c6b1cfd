// SPDX-License-Identifier: BSD-3-Clause
//
// Training from pieces by a group, here of threads.
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Training/Quality/Quality.h"
#include "Core/Training/Samples/SamplePool.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/StreamingGroup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>

namespace test::parallel_streaming {

bool SameRanges(const inr::Model& a, const inr::Model& b)
{
  return std::equal(a.macroCells.ranges.begin(), a.macroCells.ranges.end(),
                    b.macroCells.ranges.begin(), b.macroCells.ranges.end(),
                    [](const inr::ValueRange& x, const inr::ValueRange& y) {
                      return x.low == y.low && x.high == y.high;
                    });
}

std::unique_ptr<inr::SamplePool> PoolOf(const inr::BlockGrid& blocks, FieldReader<float>& reader,
                                        const inr::BlockShare& share)
{
  const inr::Arena arena(1);
  auto pool = std::make_unique<inr::SamplePool>(blocks, 1 << 16, 3, share);
  for (std::int64_t block = share.firstBlock; block < share.endBlock; ++block) {
    pool->put(block, pool->sample(block, 0, reader.read(blocks.voxels(block)), arena));
  }
  return pool;
}

// With few blocks and with more than a batch has items; 3 do not divide them.
TEST(ParallelStreaming, SharesOutTheBatchesOfOneProcess)
{
  FieldReader<float> reader(StreamedField());
  for (const std::int64_t mostVoxels : {20000, 100}) {
    const inr::BlockGrid blocks(StreamedDims, mostVoxels);
    const auto whole = PoolOf(blocks, reader, inr::BlockShare(blocks.count()));
    whole->begin(-3, 5, 1);
    for (const int size : {2, 3, 4}) {
      SCOPED_TRACE(size);
      std::vector<glm::vec3> positions;
      std::vector<float> targets;
      for (int rank = 0; rank < size; ++rank) {
        const inr::BlockShare share(blocks.count(), rank, size);
        const auto pool = PoolOf(blocks, reader, share);
        pool->begin(-3, 5, 1);
        EXPECT_EQ(pool->total(), size * inr::BatchSize);
        const auto count = static_cast<std::size_t>(pool->count());
        std::vector<glm::vec3> places(count);
        std::vector<float> values(count);
        pool->draw(9, 5, 0, pool->count(), places.data(), values.data());
        // Item by item of its share, batch by batch.
        for (int batch = 0; batch < size; ++batch) {
          std::vector<glm::vec3> expectedPlaces(static_cast<std::size_t>(share.items()));
          std::vector<float> expectedValues(expectedPlaces.size());
          whole->draw(9, static_cast<std::uint64_t>(5 * size + batch), share.firstItem,
                      share.endItem, expectedPlaces.data(), expectedValues.data());
          for (std::size_t k = 0; k < expectedPlaces.size(); ++k) {
            const std::size_t at = static_cast<std::size_t>(batch) * expectedPlaces.size() + k;
            ASSERT_EQ(places[at], expectedPlaces[k]);
            ASSERT_EQ(values[at], expectedValues[k]);
          }
        }
        positions.insert(positions.end(), places.begin(), places.end());
      }
      EXPECT_EQ(positions.size(), static_cast<std::size_t>(size * inr::BatchSize));
    }
  }
}

TEST(ParallelStreaming, GivesAllTheSameModelEveryTime)
{
  const inr::ModelPointer memory = inr::TrainModel(StreamedField().data(), {}, StreamedOptions(24));
  for (const int size : {1, 2, 3}) {
    SCOPED_TRACE(size);
    inr::TrainingOptions options = StreamedOptions(24);
    options.storedAs = size == 2 ? inr::ParameterType::Quantised : options.storedAs;
    const std::vector<Outcome> first = TrainTogether(size, options);
    const std::vector<Outcome> again = TrainTogether(size, options);
    for (std::size_t rank = 0; rank < first.size(); ++rank) {
      ASSERT_TRUE(first[rank].model) << first[rank].error->what();
      EXPECT_EQ(first[rank].model->parameters, first[0].model->parameters);
      EXPECT_EQ(again[rank].model->parameters, first[0].model->parameters);
      EXPECT_EQ(first[rank].model->quality->psnr, first[0].model->quality->psnr);
      // Its part of three times the volume, and the layers between these small blocks.
      EXPECT_LT(first[rank].voxelsRead,
                5.0 * static_cast<double>(StreamedField().data().voxels()) / size);
    }
    EXPECT_EQ(first[0].model->volume.low, memory->volume.low);
    EXPECT_EQ(first[0].model->volume.high, memory->volume.high);
    EXPECT_GT(first[0].model->quality->psnr, memory->quality->psnr - 1);
  }
}

TEST(ParallelStreaming, MeasuresTheWholeVolume)
{
  Field<float> field = StreamedField();
  field.values[4000] = NAN;
  for (const std::int64_t measured : {std::int64_t{1} << 26, std::int64_t{1} << 14}) {
    inr::TrainingOptions options = StreamedOptions(30);
    options.measuredVoxels = measured;
    const std::vector<Outcome> outcomes = TrainTogether(3, options, {}, {}, field);
    ASSERT_TRUE(outcomes[1].model) << outcomes[1].error->what();
    const inr::Model& model = *outcomes[1].model;
    const inr::DecodedReport truth = inr::MeasureQuality(
        *inr::MakeEvaluator(outcomes[1].model), field.data(), model.volume, 16, inr::Arena(), {});
    const bool all = model.quality->sampledVoxels == 0;
    EXPECT_EQ(all, measured == std::int64_t{1} << 26);
    EXPECT_NEAR(model.quality->psnr, truth.quality.psnr, all ? 1e-6 : 2);
    EXPECT_EQ(model.training->nonFinite, 1u);
    ASSERT_EQ(model.macroCells.ranges.size(), truth.macroCells.ranges.size());
    EXPECT_TRUE(SameRanges(model, *outcomes[0].model));
    EXPECT_TRUE(SameRanges(model, *outcomes[2].model));
    for (std::size_t k = 0; k < truth.macroCells.ranges.size(); ++k) {
      const inr::ValueRange& found = model.macroCells.ranges[k];
      const inr::ValueRange& decoded = truth.macroCells.ranges[k];
      EXPECT_LE(found.low, decoded.low + 1e-6);
      EXPECT_GE(found.high, decoded.high - 1e-6);
      if (all) {
        EXPECT_NEAR(found.low, decoded.low, 1e-6);
        EXPECT_NEAR(found.high, decoded.high, 1e-6);
      }
    }
  }
}

// While surveying, training and measuring.
TEST(ParallelStreaming, StopsForAllWhenOneCannotRead)
{
  const int reads = TrainTogether(3, StreamedOptions(20))[1].reads;
  ASSERT_GE(reads, 11 + 2 + 1); // of 32 blocks, some of them again, and a box
  for (const int failing : {2, 12, reads}) {
    ExpectErrors(TrainTogether(3, StreamedOptions(20),
                               [&](int rank, int reading) {
                                 if (rank == 1 && reading == failing) {
                                   throw inr::Error(inr::ErrorCode::CannotRead,
                                                    "the disk is on fire");
                                 }
                               }),
                 "on fire");
  }
}

TEST(ParallelStreaming, SaysWhatToDoWhereAReaderHasNoMemory)
{
  ExpectErrors(TrainTogether(2, StreamedOptions(20),
                             [&](int rank, int reading) {
                               rank == 1 && reading == 2 ? throw std::bad_alloc() : void();
                             }),
               "not enough memory to read the data");
}

TEST(ParallelStreaming, StopsForAllWhenOneIsToldToInEveryPhase)
{
  for (const inr::TrainingPhase phase :
       {inr::TrainingPhase::Reading, inr::TrainingPhase::Training, inr::TrainingPhase::Measuring}) {
    inr::TrainingOptions options = StreamedOptions(50);
    options.storedAs = inr::ParameterType::Half; // or quantising would ask, too, if it takes long
    ExpectErrors(TrainTogether(2, options, {},
                               [phase](int rank, const inr::TrainingProgress& now) {
                                 return rank == 0 || now.phase != phase;
                               }),
                 "stopped");
  }
}

TEST(ParallelStreaming, GoesOnFromItsCheckpoint)
{
  const TemporaryFolder folder;
  const inr::ModelPointer whole = TrainTogether(2, StreamedOptions(40))[0].model;
  inr::TrainingOptions options = StreamedOptions(40);
  options.checkpoint.path = folder.file("a.checkpoint");
  const auto stop = [](int rank, const inr::TrainingProgress& now) {
    return rank != 1 || now.steps < 23;
  };
  const std::vector<Outcome> stopped = TrainTogether(2, options, {}, stop);
  ExpectErrors(stopped, "stopped");
  EXPECT_NE(std::string(stopped[0].error->what()).find("23 steps are kept"), std::string::npos);
  EXPECT_EQ(TrainTogether(2, options)[1].model->parameters, whole->parameters);
}

// Of a training that was too short for a checkpoint; none ends before it is written.
TEST(ParallelStreaming, KeepsAllStepsWhenItIsStoppedBehindThem)
{
  const TemporaryFolder folder;
  inr::TrainingOptions options = StreamedOptions(20);
  const inr::ModelPointer whole = TrainTogether(2, options)[0].model;
  options.checkpoint.path = folder.file("a.checkpoint");
  const std::vector<Outcome> stopped =
      TrainTogether(2, options, {}, [](int rank, const inr::TrainingProgress& now) {
        return rank != 1 || now.phase != inr::TrainingPhase::Measuring;
      });
  ExpectErrors(stopped, "stopped");
  EXPECT_TRUE(stopped[0].leftCheckpoint && stopped[1].leftCheckpoint);
  EXPECT_NE(std::string(stopped[0].error->what()).find("20 steps are kept"), std::string::npos);
  EXPECT_EQ(TrainTogether(2, options)[1].model->parameters, whole->parameters);
}

// Both have to read the same blocks.
TEST(ParallelStreaming, HeedsTheSmallestMemoryLimitAndTheLargestVoxels)
{
  class WithOtherArrays : public FieldReader<float>
  {
  public:
    WithOtherArrays(const Field<float>& field, std::int64_t bytes)
        : FieldReader<float>(field), Bytes(bytes)
    {}
    std::int64_t bytesPerVoxel() const override { return this->Bytes; }

  private:
    std::int64_t Bytes;
  };
  struct Process
  {
    std::int64_t limit;
    std::int64_t bytesPerVoxel;
  };
  const auto train = [](const Process& first, const Process& second) {
    std::vector<inr::ModelPointer> models(2);
    InGroup(2, [&](const ThreadGroup& group) {
      const Process& process = group.rank() == 0 ? first : second;
      inr::TrainingOptions options = StreamedOptions(3);
      options.memoryLimit = process.limit;
      WithOtherArrays reader(StreamedField(), process.bytesPerVoxel);
      models[static_cast<std::size_t>(group.rank())] = inr::TrainModel(reader, {}, options, group);
    });
    EXPECT_EQ(models[0]->parameters, models[1]->parameters);
    return models[0]->parameters;
  };
  const Process small{150 * MiB, 400};
  const Process large{400 * MiB, 400};
  const Process narrow{150 * MiB, 4};
  const inr::AlignedVector<float> expected = train(small, small);
  EXPECT_NE(train(large, large), expected) << "the limit does not matter here";
  EXPECT_EQ(train(small, large), expected);
  EXPECT_EQ(train(large, small), expected);
  EXPECT_NE(train(narrow, narrow), expected) << "other arrays do not matter here";
  EXPECT_EQ(train(narrow, small), expected);
  EXPECT_EQ(train(small, narrow), expected);
}

TEST(ParallelStreaming, RefusesDifferentTypes)
{
  const Field<double> doubles = WaveField<double>(StreamedDims, inr::ScalarType::Float64, -3, 5);
  std::vector<Outcome> outcomes(2);
  InGroup(2, [&](const ThreadGroup& group) {
    FieldReader<float> floatReader(StreamedField());
    FieldReader<double> doubleReader(doubles);
    inr::VolumeReader* const readers[] = {&floatReader, &doubleReader};
    try {
      inr::TrainModel(*readers[group.rank()], {}, StreamedOptions(2), group);
    } catch (const inr::Error& error) {
      outcomes[static_cast<std::size_t>(group.rank())].error = error;
    }
  });
  ExpectErrors(outcomes, "different types");
}

TEST(ParallelStreaming, SaysHowMuchMemoryEachProcessNeeds)
{
  inr::TrainingOptions options = StreamedOptions(10);
  options.memoryLimit = 100 * MiB;
  ExpectErrors(TrainTogether(2, options),
               "in each process and its share of the MemoryLimit is 100 MiB");
}

} // namespace test::parallel_streaming
