// SPDX-License-Identifier: BSD-3-Clause
//
// What a pool gives is what the volume holds, and every region of it equally often.
#include "Core/Training/Runtime/LearningRate.h"
#include "Core/Training/Samples/SamplePool.h"
#include "Testing/Core/Training/FieldReader.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

namespace test::sample_pool {

constexpr std::uint64_t Planned = 100;

class Pool : public testing::Test
{
public:
  Pool()
  {
    for (std::int64_t block = 0; block < this->Grid.count(); ++block) {
      this->Samples.put(block, this->sample(block, 0));
    }
    this->Samples.begin(-1, 1, 1.0);
  }

  std::vector<double> sample(std::int64_t block, std::uint32_t round)
  {
    return this->Samples.sample(block, round, this->Reader.read(this->Grid.voxels(block)),
                                this->Threads);
  }

  /// All blocks again, as fast as they are wanted, until step `last` is prepared.
  void goOnTo(std::uint64_t last)
  {
    std::atomic<bool> done{false};
    std::thread trainer([&] {
      this->Samples.prepare({last, Planned}, inr::StopCheck());
      done = true;
    });
    while (!done) {
      if (const auto block = this->Samples.wanted()) {
        this->Samples.offer(*block, this->sample(*block, 1));
        ++this->Rereads;
      }
    }
    trainer.join();
  }

  void draw(std::uint64_t step)
  {
    this->Samples.draw(1, step, 0, inr::BatchSize, this->Positions.data(), this->Targets.data());
  }

  Field<float> Volume = WaveField<float>({50, 41, 37}, inr::ScalarType::Float32, -1, 1);
  FieldReader<float> Reader{this->Volume};
  inr::Arena Threads{2};
  inr::BlockGrid Grid{this->Volume.dims, 12000};
  inr::SamplePool Samples{this->Grid, 1 << 15, 3, inr::BlockShare(this->Grid.count())};
  int Rereads = 0;
  std::vector<glm::vec3> Positions = std::vector<glm::vec3>(inr::BatchSize);
  std::vector<float> Targets = std::vector<float>(inr::BatchSize);
};

TEST_F(Pool, HoldsTheValuesOfItsPositions)
{
  ASSERT_GE(this->Grid.count(), 8);
  EXPECT_EQ(this->Samples.samples(), 1 << 15);
  const inr::InMemorySource source(this->Volume.data(), -1, 1);
  std::vector<float> expected(inr::BatchSize);
  for (const std::uint64_t step : {0u, 60u, 100u}) {
    this->goOnTo(step);
    this->draw(step);
    source.sample(this->Positions.data(), inr::BatchSize, expected.data());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      // A voxel's centre may round to just outside of its block.
      ASSERT_NEAR(this->Targets[k], expected[k], 1e-6) << step << " " << k;
    }
  }
  EXPECT_EQ(this->Rereads, this->Grid.count());
}

TEST_F(Pool, GivesEveryRegionItsShareInEveryBatch)
{
  for (std::uint64_t step = 0; step < 4; ++step) {
    this->draw(step);
    std::array<int, 64> counts{};
    for (const glm::vec3& position : this->Positions) {
      const glm::ivec3 cell(4.0f * position);
      ++counts.at(static_cast<std::size_t>(cell.x + 4 * (cell.y + 4 * cell.z)));
    }
    for (const int count : counts) { // voxels' centres may lie across a border
      EXPECT_NEAR(count, inr::BatchSize / 64, 0.25 * inr::BatchSize / 64);
    }
  }
}

// Another position in every box once a block was read again; the same ones until then.
TEST_F(Pool, DrawsNewSamplesOfWhatIsReadAgain)
{
  this->goOnTo(Planned / inr::LearningRate::ConstantShare); // the rate is constant: none yet
  EXPECT_EQ(this->Rereads, 0);
  this->draw(0);
  const std::vector<glm::vec3> before = this->Positions;
  this->goOnTo(55);
  EXPECT_GE(this->Rereads, this->Grid.count() / 2);
  EXPECT_LT(this->Rereads, this->Grid.count());
  this->draw(0);
  int moved = 0;
  int toOtherVoxels = 0; // more than from a voxel's centre to another place in it, or back
  for (std::size_t k = 0; k < before.size(); ++k) {
    moved += before[k] != this->Positions[k] ? 1 : 0;
    toOtherVoxels += inr::VoxelCentre(before[k], this->Volume.dims) !=
                             inr::VoxelCentre(this->Positions[k], this->Volume.dims)
                         ? 1
                         : 0;
  }
  EXPECT_GT(toOtherVoxels, moved / 4);
  EXPECT_NEAR(moved, inr::BatchSize / 2, inr::BatchSize / 8);
}

TEST_F(Pool, WaitsForTheReaderNoLongerThanItIsLet)
{
  int asked = 0;
  this->Samples.prepare({90, Planned}, inr::StopCheck([&] { return ++asked < 3; }));
  EXPECT_EQ(asked, 3);
}

} // namespace test::sample_pool
