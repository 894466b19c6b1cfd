// SPDX-License-Identifier: BSD-3-Clause
//
// Updates of layers by the GPU's kernel, on the host, beside Core's.
#include "CUDA/Training/Kernels/TrainLayers.h"
#include "CUDA/Training/Kernels/TrainUpdate.h"
#include "Core/Random.h"
#include "Core/Training/Descent/TrainKernel.h"
#include "Testing/CUDA/HostMachine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace test::train_layers {

constexpr float Kept = 0.95f;
constexpr float Rate = 0.02f;
constexpr std::int64_t Shards = 3;

/// Weights of three layers of a network with an output, in training.
struct Network
{
  Network()
  {
    for (const auto& [rows, columns] : {std::pair{33, 20}, {33, 33}, {5, 33}, {1, 5}}) {
      inr::cuda::TrainLayer layer{};
      layer.rows = rows;
      layer.columns = columns;
      layer.firstWeight = this->count;
      this->count += std::int64_t{rows} * columns;
      this->layers.push_back(layer);
    }
    const auto random = [&](std::uint64_t seed, std::int64_t size) {
      std::vector<float> values;
      for (std::int64_t k = 0; k < size; ++k) {
        values.push_back(inr::RandomUnit(seed, static_cast<std::uint64_t>(k)) - 0.4f);
      }
      return values;
    };
    this->weights = random(1, this->count);
    this->momentum = random(2, this->count);
    this->gradients = random(3, Shards * this->count);
  }

  /// The first three layers, by the kernel.
  void update(HostLaunch launch)
  {
    std::int64_t ofLayer = 0;
    for (const inr::cuda::TrainLayer& layer : this->layers) {
      ofLayer = std::max(ofLayer, inr::cuda::TallLayer(layer.rows, layer.columns).workspace());
    }
    std::vector<float> workspace(static_cast<std::size_t>(3 * ofLayer), NAN);
    std::vector<float> sums = this->gradients;
    const HostMachine machine(launch);
    machine.run(inr::cuda::TrainSumShards{sums.data(), this->count, Shards}, this->count);
    const inr::cuda::TrainUpdateLayers kernel{this->layers.data(),
                                              3,
                                              this->weights.data(),
                                              this->momentum.data(),
                                              sums.data(),
                                              Kept,
                                              Rate,
                                              workspace.data(),
                                              ofLayer};
    machine.run(kernel, 3 * inr::cuda::TrainUpdateLayers::Threads,
                inr::cuda::TrainUpdateLayers::SharedBytes);
    for (std::int64_t l = 0; l < 3; ++l) {
      this->left.push_back(workspace[static_cast<std::size_t>(l * ofLayer)]);
    }
  }

  /// The same by Core.
  void updateByCore()
  {
    const inr::TrainKernel& train = inr::TrainKernelFor(inr::ChooseInstructionSet(""));
    for (std::size_t l = 0; l < 3; ++l) {
      const inr::cuda::TrainLayer& layer = this->layers[l];
      const std::int64_t size = std::int64_t{layer.rows} * layer.columns;
      std::vector<float> sums(static_cast<std::size_t>(size));
      for (std::int64_t shard = 0; shard < Shards; ++shard) {
        for (std::int64_t k = 0; k < size; ++k) {
          sums[static_cast<std::size_t>(k)] += this->gradients[static_cast<std::size_t>(
              shard * this->count + layer.firstWeight + k)];
        }
      }
      std::vector<float> workspace(
          static_cast<std::size_t>(train.orthogonalWorkspace(layer.rows, layer.columns)));
      train.orthogonal({&this->weights[static_cast<std::size_t>(layer.firstWeight)], sums.data(),
                        &this->momentum[static_cast<std::size_t>(layer.firstWeight)], layer.rows,
                        layer.columns, Kept, Rate},
                       workspace.data());
    }
  }

  void scale(float size)
  {
    for (std::vector<float>* const values : {&this->gradients, &this->momentum}) {
      std::for_each(values->begin(), values->end(), [size](float& value) { value *= size; });
    }
  }

  std::int64_t count = 0;
  std::vector<inr::cuda::TrainLayer> layers;
  std::vector<float> weights, momentum, gradients;
  std::vector<float> left; ///< in the workspace, the first number of each layer's
};

/// NaN is near NaN.
void ExpectNear(const std::vector<float>& found, const std::vector<float>& expected,
                float tolerance)
{
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (std::isnan(found[k]) != std::isnan(expected[k]) ||
        std::abs(found[k] - expected[k]) > tolerance) {
      FAIL() << k << ": " << found[k] << " " << expected[k];
    }
  }
}

void ExpectCores(const Network& before)
{
  for (const HostLaunch launch : {HostLaunch{1}, HostLaunch{2, true}, HostLaunch{7}}) {
    Network found = before;
    found.update(launch);
    Network expected = before;
    expected.updateByCore();
    ExpectNear(found.weights, expected.weights, 1e-4f * Rate);
    ExpectNear(found.momentum, expected.momentum, 1e-30f);
  }
}

TEST(TrainLayers, MoveAsInCore)
{
  Network network;
  network.scale(1e-31f); // so that momentum is compared to some bits
  ExpectCores(network);
}

TEST(TrainLayers, MoveAsInCoreWhateverTheGradientsSize)
{
  for (const float size : {1e-37f, 1e-20f, 1e20f, 3e37f}) {
    Network found;
    found.scale(size);
    Network expected = found;
    found.update({});
    expected.updateByCore();
    ExpectNear(found.weights, expected.weights, 1e-4f * Rate);
  }
}

TEST(TrainLayers, StayWithoutAGradient)
{
  Network network;
  std::fill(network.gradients.begin(), network.gradients.end(), 0.0f);
  const Network before = network;
  network.update({});
  EXPECT_EQ(network.weights, before.weights);
  std::fill(network.momentum.begin(), network.momentum.end(), 0.0f);
  network.gradients[3] = 1e-45f; // of which nothing is left in the momentum
  network.update({});
  EXPECT_EQ(network.weights, before.weights);
}

TEST(TrainLayers, AreNoNumbersWhereOneIsNone)
{
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    for (const std::size_t place : {0, 400, 659}) {
      Network network;
      network.gradients[place] = bad;
      network.update({});
      for (std::size_t k = 0; k < network.weights.size(); ++k) {
        ASSERT_EQ(std::isnan(network.weights[k]), k < 660) << k; // the first layer
      }
    }
  }
}

/// Blocks may be at work at once.
TEST(TrainLayers, HaveAWorkspaceEach)
{
  Network network;
  network.update({});
  for (const float value : network.left) {
    EXPECT_TRUE(std::isfinite(value));
  }
}

} // namespace test::train_layers
