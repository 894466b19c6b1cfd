// SPDX-License-Identifier: BSD-3-Clause
//
// A training's kernels against Core's: gradients, updates, losses, samples.
#include "Testing/CUDA/Places.h"
#include "Testing/CUDA/TrainSetup.h"
#include "Testing/Core/Training/MatrixTruth.h"

namespace test::training {

class Training : public InAPlace
{
protected:
  static std::shared_ptr<const inr::TrainingAccelerator> accelerator()
  {
    if (GetParam() == Place::Gpu) {
      return inr::cuda::MakeTrainer(inr::cuda::ChooseDevice());
    }
    return std::make_shared<EmulatedTrainer>();
  }

  /// Gradients of one step, which the first moments tell, and what it does with them.
  static void expectSameStep(const inr::Description& description, const std::string& what,
                             std::int64_t count = 700, float size = 0.4f)
  {
    GivenBatches batches(count);
    batches.Targets[5] = NAN;
    TrainPair pair(description, *accelerator(), batches, size);
    const auto [expected, loss] = pair.step(batches);
    ASSERT_TRUE(std::isfinite(expected)) << what;
    EXPECT_NEAR(loss, expected, 1e-5 * expected) << what;
    expectSame(pair.ofDevice(), pair.ofCore(), pair.Core.weightCount(), what);
  }

  static void expectSame(const TrainState& device, const TrainState& core, std::size_t weights,
                         const std::string& what)
  {
    const auto part = [](const std::vector<float>& all, std::size_t begin, std::size_t end) {
      return std::vector<float>(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                all.begin() + static_cast<std::ptrdiff_t>(end));
    };
    for (const auto& [begin, end] :
         {std::pair{std::size_t{0}, weights}, std::pair{weights, device.first.size()}}) {
      EXPECT_LT(RelativeError(part(device.first, begin, end), part(core.first, begin, end)), 1e-5)
          << what << ", " << (begin == 0 ? "network" : "grid");
    }
    long others = 0;
    for (std::size_t k = 0; k < core.updates.size(); ++k) {
      others += core.updates[k] != device.updates[k] ? 1 : 0;
    }
    EXPECT_LE(others, static_cast<long>(core.updates.size() / 1000)) << what;
  }
};

TEST_P(Training, AgreesForEveryActivation)
{
  using inr::Activation;
  for (const Activation activation :
       {Activation::None, Activation::ReLU, Activation::LeakyReLU, Activation::Exponential,
        Activation::Sigmoid, Activation::Sine, Activation::Squareplus, Activation::Softplus,
        Activation::Tanh}) {
    inr::Description description = SmallDescription();
    description.network.activation = activation;
    expectSameStep(description, "activation " + std::to_string(static_cast<int>(activation)));
    description.network.activation = Activation::ReLU;
    description.network.outputActivation = activation;
    expectSameStep(description, "output " + std::to_string(static_cast<int>(activation)));
  }
}

TEST_P(Training, AgreesForEveryShape)
{
  for (const int features : {1, 2, 4, 8}) {
    for (const int hidden : {0, 1, 3}) {
      inr::Description description = SmallDescription();
      description.grid.features = features;
      description.network.hiddenLayers = hidden;
      expectSameStep(description,
                     "features " + std::to_string(features) + " hidden " + std::to_string(hidden));
    }
  }
  for (const int neurons : {1, 15, 33, 64, 100}) {
    inr::Description description = SmallDescription();
    description.network.neurons = neurons;
    description.network.alignment = 8;
    description.network.activation = inr::Activation::LeakyReLU;
    expectSameStep(description, "neurons " + std::to_string(neurons), 100);
  }
}

TEST_P(Training, AgreesForEveryGrid)
{
  for (const inr::GridType type :
       {inr::GridType::Hash, inr::GridType::Dense, inr::GridType::Tiled}) {
    for (const inr::GridInterpolation interpolation :
         {inr::GridInterpolation::Linear, inr::GridInterpolation::Smoothstep,
          inr::GridInterpolation::Nearest}) {
      inr::Description description = SmallDescription();
      description.grid.type = type;
      description.grid.interpolation = interpolation;
      description.grid.perLevelScale = 1.7f;
      expectSameStep(description, "grid " + std::to_string(static_cast<int>(type)));
    }
  }
  for (const inr::HashFunction hash :
       {inr::HashFunction::Prime, inr::HashFunction::ReversedPrime, inr::HashFunction::Rng}) {
    inr::Description description = SmallDescription();
    description.grid.hash = hash;
    expectSameStep(description, "hash " + std::to_string(static_cast<int>(hash)));
  }
}

TEST_P(Training, AgreesForALargeNetwork)
{
  inr::Description description = SmallDescription();
  description.network.neurons = 300;
  description.network.hiddenLayers = 3;
  description.network.activation = inr::Activation::LeakyReLU;
  expectSameStep(description, "300 neurons", 130, 0.1f);
}

/// All samples in one place add up there, whichever feature's gradients are the largest by far.
TEST_P(Training, NoSumOverflows)
{
  inr::Description description = SmallDescription();
  description.network.activation = inr::Activation::LeakyReLU;
  const inr::Layout layout(description);
  for (const int column : {0, 7, layout.encodedWidth - 1}) {
    GivenBatches batches(512);
    std::fill(batches.Positions.begin(), batches.Positions.end(), glm::vec3(0.31f, 0.62f, 0.83f));
    std::fill(batches.Targets.begin(), batches.Targets.end(), 0.75f);
    TrainPair pair(description, *accelerator(), batches);
    for (int row = 0; row < layout.layers[0].rows; ++row) {
      pair.Core.parameters()[static_cast<std::size_t>(row * layout.layers[0].columns + column)] *=
          1e5f;
    }
    pair.Device->put(pair.Core.state());
    pair.step(batches);
    expectSame(pair.ofDevice(), pair.ofCore(), pair.Core.weightCount(),
               "column " + std::to_string(column));
  }
}

/// An update of parameters by Adam, from what moments tell of the gradient.
void ExpectAdam(const TrainState& before, const TrainState& after, std::size_t p,
                const inr::AdamStep& step, float rate)
{
  const double gradient = (double(after.first[p]) - 0.9f * double(before.first[p])) / 0.1;
  const double second =
      step.beta2 * double(before.second[p]) + (1.0 - step.beta2) * gradient * gradient;
  ASSERT_NEAR(after.second[p], second, 1e-3 * second + 1e-5 * before.second[p]) << p;
  const float move =
      rate * step.rate * after.first[p] / (std::sqrt(after.second[p]) + inr::AdamEpsilon);
  ASSERT_NEAR(after.values[p], before.values[p] - move, 1e-6f) << p;
}

/// An update of a layer by orthogonalised momentum, from what that tells of the gradient.
void ExpectOrthogonalised(const TrainState& before, const TrainState& after,
                          const inr::LayerShape& layer, double rate)
{
  Matrix direction(layer.rows, layer.columns);
  for (std::size_t k = 0; k < direction.values.size(); ++k) {
    const std::size_t p = layer.offset + k;
    const double momentum = after.first[p];
    direction.values[k] = momentum - 0.95 * double(before.first[p]) + 0.95 * momentum;
  }
  const Matrix expected = NearlyOrthogonal(direction);
  for (std::size_t k = 0; k < direction.values.size(); ++k) {
    const std::size_t p = layer.offset + k;
    ASSERT_NEAR(after.values[p], before.values[p] - rate * expected.values[k], 1e-7 + 2e-4 * rate)
        << p;
    ASSERT_EQ(after.second[p], before.second[p]) << p;
  }
}

/// From the same gradients the same parameters, moments and counts, whatever they were before.
TEST_P(Training, UpdatesAreCoresOwn)
{
  GivenBatches batches(300);
  const inr::Layout layout(SmallDescription());
  const std::size_t lastLayer = layout.layers.back().offset;
  TrainPair pair(SmallDescription(), *accelerator(), batches);
  pair.Steps = 18; // rates of layers change from the 26th on
  const std::vector<inr::AdamStep> steps = inr::AdamUpdates();
  for (int k = 0; k < 12; ++k) {
    const TrainState before = pair.ofDevice();
    pair.stepOnDevice(batches);
    const TrainState after = pair.ofDevice();
    const float rate = inr::LearningRate().at(pair.Steps - 1, TrainPair::Planned);
    const double orthogonal = rate * inr::OrthogonalRate(pair.Steps);
    ExpectOrthogonalised(before, after, layout.layers[0], orthogonal);
    ExpectOrthogonalised(before, after, layout.layers[1], orthogonal);
    for (std::size_t p = lastLayer; p < layout.gridOffset; ++p) {
      ExpectAdam(before, after, p, steps[pair.Steps], rate);
    }
    long moved = 0;
    for (std::size_t p = layout.gridOffset; p < after.values.size(); ++p) {
      const std::size_t g = p - layout.gridOffset;
      if (after.updates[g] != before.updates[g]) {
        ++moved;
        ExpectAdam(before, after, p, steps[after.updates[g]], rate);
        continue;
      }
      ASSERT_EQ(after.values[p], before.values[p]);
      ASSERT_EQ(after.first[p], before.first[p]);
      ASSERT_EQ(after.second[p], before.second[p]);
    }
    EXPECT_GT(moved, 1000);
  }
}

/// Layers of every shape, the widest too, by a few steps of their own.
TEST_P(Training, OrthogonalisesLayersOfEveryShape)
{
  GivenBatches batches(300);
  for (const int neurons : {1, 7, 16, 33, 100, 128}) {
    SCOPED_TRACE(neurons);
    inr::Description description = SmallDescription();
    description.network.neurons = neurons;
    description.network.activation = inr::Activation::LeakyReLU;
    const inr::Layout layout(description);
    TrainPair pair(description, *accelerator(), batches, 0.2f);
    for (int k = 0; k < 3; ++k) {
      const TrainState before = pair.ofDevice();
      pair.stepOnDevice(batches);
      const double rate = inr::LearningRate().at(pair.Steps - 1, TrainPair::Planned) *
                          inr::OrthogonalRate(pair.Steps);
      for (std::size_t l = 0; l + 1 < layout.layers.size(); ++l) {
        ExpectOrthogonalised(before, pair.ofDevice(), layout.layers[l], rate);
      }
    }
  }
}

/// Some steps later, with a learning rate that falls and parameters that were not touched before.
TEST_P(Training, StaysNearCoreForSomeSteps)
{
  const Field<float> field = WaveField();
  const inr::InMemorySource source(field.data(), -1, 1);
  inr::Description description = SmallDescription();
  description.grid.features = 2;
  inr::StratifiedBatches batches(source);
  TrainPair pair(description, *accelerator(), batches, 1e-2f);
  double expected = 0;
  double loss = 0;
  for (int k = 0; k < 25; ++k) {
    std::tie(expected, loss) = pair.step(batches);
    ASSERT_NEAR(loss, expected, 0.01 * expected) << k;
  }
  double squared = 0;
  double moved = 0;
  const TrainState device = pair.ofDevice();
  const TrainState core = pair.ofCore();
  for (std::size_t k = 0; k < core.values.size(); ++k) {
    squared += std::pow(double(core.values[k]) - double(device.values[k]), 2);
    moved += std::pow(double(core.values[k]), 2);
  }
  EXPECT_LT(std::sqrt(squared / moved), 0.02);
}

TEST_P(Training, UnknownTargetsCarryNothing)
{
  GivenBatches batches(300);
  std::fill(batches.Targets.begin(), batches.Targets.end(), NAN);
  TrainPair pair(SmallDescription(), *accelerator(), batches);
  const TrainState before = pair.ofDevice();
  EXPECT_EQ(pair.stepOnDevice(batches), 0.0);
  const TrainState after = pair.ofDevice();
  const auto weights = static_cast<std::ptrdiff_t>(pair.Core.weightCount());
  EXPECT_TRUE(std::equal(before.values.begin() + weights, before.values.end(),
                         after.values.begin() + weights));
  EXPECT_EQ(after.updates, before.updates);
  const auto lastLayer =
      static_cast<std::ptrdiff_t>(inr::Layout(SmallDescription()).layers.back().offset);
  EXPECT_TRUE(
      std::equal(before.values.begin(), before.values.begin() + lastLayer, after.values.begin()));
}

/// As with Core, it is seen in the next loss at the latest.
TEST_P(Training, WhatIsNoNumberIsSeenInTheLoss)
{
  GivenBatches batches(300);
  inr::Description description = SmallDescription();
  description.network.activation = inr::Activation::Exponential;
  TrainPair pair(description, *accelerator(), batches, 30.0f);
  double core = *pair.Core.step(batches);
  double device = pair.stepOnDevice(batches);
  core += *pair.Core.step(batches);
  device += pair.stepOnDevice(batches);
  EXPECT_FALSE(std::isfinite(core));
  EXPECT_FALSE(std::isfinite(device));
}

/// What is drawn on the device is what the host draws, and so is what comes of it.
TEST_P(Training, DrawsOnTheDeviceWhatTheHostDraws)
{
  const Field<float> field = WaveField();
  const inr::InMemorySource source(field.data(), -1, 1);
  inr::StratifiedBatches batches(source);
  GivenBatches unlike(batches.count());
  TrainPair there(SmallDescription(), *accelerator(), batches);
  ASSERT_TRUE(there.Device->drawsSamples());
  TrainPair here(SmallDescription(), *accelerator(), unlike); // knows of no volume
  ASSERT_FALSE(here.Device->drawsSamples());
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(there.stepOnDevice(batches), here.stepOnDevice(batches));
  }
  EXPECT_TRUE(there.ofDevice() == here.ofDevice());
}

INSTANTIATE_TEST_SUITE_P(Kernels, Training, testing::Values(Place::Host, Place::Gpu),
                         InAPlace::nameOf);

/// Draws with the kernel, on the host, and with Core's source.
template <class T>
void ExpectSameSamples(const Field<T>& field, std::int64_t stride, double low, double high)
{
  std::vector<T> spread(field.values.size() * static_cast<std::size_t>(stride));
  for (std::size_t k = 0; k < field.values.size(); ++k) {
    spread[k * static_cast<std::size_t>(stride)] = field.values[k];
  }
  inr::VolumeData volume = field.data();
  volume.values = spread.data();
  volume.stride = stride;
  const inr::InMemorySource source(volume, low, high);
  const inr::StratifiedBatches batches(source);
  const auto count = static_cast<std::size_t>(batches.count());
  std::vector<glm::vec3> positions(count), expectedPositions(count);
  std::vector<float> targets(count), expectedTargets(count);
  HostMachine machine;
  const inr::cuda::PackedVolume<HostMachine> packed(machine, {volume, low, high}, batches.count());
  for (const std::uint64_t step : {0ull, 1ull, 123456789012ull}) {
    packed.draw(machine, 77, step, &positions[0].x, targets.data());
    batches.draw(77, step, 0, batches.count(), expectedPositions.data(), expectedTargets.data());
    EXPECT_EQ(positions, expectedPositions);
    EXPECT_TRUE(
        std::equal(targets.begin(), targets.end(), expectedTargets.begin(),
                   [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }))
        << inr::ScalarName(field.type) << " " << stride;
  }
}

template <class T> void ExpectSameSamples(inr::ScalarType type, double low, double high)
{
  for (const glm::i64vec3 dims : {glm::i64vec3(9, 7, 5), glm::i64vec3(1, 30, 1)}) {
    const Field<T> field = WaveField<T>(dims, type, low, high);
    ExpectSameSamples(field, 1, low, high);
    ExpectSameSamples(field, 3, low, high);
  }
}

TEST(TrainDraw, IsCoresForEveryType)
{
  using inr::ScalarType;
  ExpectSameSamples<std::int8_t>(ScalarType::Int8, -100, 100);
  ExpectSameSamples<std::uint8_t>(ScalarType::UInt8, 0, 255);
  ExpectSameSamples<std::int16_t>(ScalarType::Int16, -3e4, 3e4);
  ExpectSameSamples<std::uint16_t>(ScalarType::UInt16, 0, 6e4);
  ExpectSameSamples<std::int32_t>(ScalarType::Int32, -2e9, 2e9);
  ExpectSameSamples<std::uint32_t>(ScalarType::UInt32, 1e9, 4e9);
  ExpectSameSamples<std::int64_t>(ScalarType::Int64, 9.1e18, 9.2e18);
  ExpectSameSamples<std::uint64_t>(ScalarType::UInt64, 1.6e19, 1.8e19);
  ExpectSameSamples<float>(ScalarType::Float32, -1e-30, 1e-30);
  ExpectSameSamples<double>(ScalarType::Float64, 1e9, 1e9 + 1e-3);
}

/// Which differ by less than a double of their size shows.
TEST(TrainDraw, IsCoresForLargeIntegersThatAreCloseTogether)
{
  Field<std::int64_t> field{{9, 7, 5}, inr::ScalarType::Int64, {}};
  const std::int64_t least = (std::int64_t{1} << 60) + 1;
  for (std::int64_t k = 0; k < 9 * 7 * 5; ++k) {
    field.values.push_back(least + k * k % 97);
  }
  const double low = inr::DoubleBelow(least);
  ExpectSameSamples(field, 1, low, low + 512);
}

TEST(TrainDraw, IsCoresAmongVoxelsThatAreNoNumbers)
{
  Field<double> field = WaveField<double>({9, 7, 5}, inr::ScalarType::Float64, -1, 1);
  for (std::size_t k = 0; k < field.values.size(); k += 4) {
    field.values[k] = k % 3 == 0 ? NAN : (k % 3 == 1 ? INFINITY : -INFINITY);
  }
  ExpectSameSamples(field, 1, -1.0, 1.0);
}

/// Order of threads and number of blocks change no bit: sums have an order of their own or none.
TEST(TrainSums, DependOnNoOrder)
{
  GivenBatches batches(1500);
  const auto after = [&](HostLaunch launch) {
    const EmulatedTrainer trainer(std::numeric_limits<std::int64_t>::max(), launch);
    TrainPair pair(SmallDescription(), trainer, batches);
    pair.stepOnDevice(batches);
    pair.stepOnDevice(batches);
    return pair.ofDevice();
  };
  HostLaunch one;
  one.blocks = 1;
  HostLaunch many;
  many.blocks = 7;
  many.backward = true;
  EXPECT_TRUE(after(one) == after(many));
}

/// No sum of the largest gradients overflows, and small ones beside them are kept.
TEST(TrainSums, HoldTheLargestAndTheSmallest)
{
  for (const float largest : {1e-38f, 3.5e-7f, 1.0f, 3e38f}) {
    for (const std::int64_t samples : {1, 1000, 16384}) {
      const inr::cuda::GradientUnit unit(inr::cuda::MagnitudeBits(largest), samples);
      const std::uint64_t one = unit.toUnits(1.0f, -largest);
      std::uint64_t sum = 0;
      for (std::int64_t k = 0; k < samples; ++k) {
        sum += one;
      }
      const double expected = -static_cast<double>(samples) * static_cast<double>(largest);
      if (expected > -3.4e38) {
        EXPECT_FLOAT_EQ(unit.toGradient(sum), static_cast<float>(expected));
      }
      EXPECT_LT(static_cast<std::int64_t>(sum), 0);
      const float small = largest * 1e-9f;
      if (small > 1e-37f) {
        EXPECT_NEAR(unit.toGradient(unit.toUnits(0.5f, small)), 0.5f * small, 1e-5f * small);
      }
    }
  }
  EXPECT_EQ(inr::cuda::GradientUnit(0, 5).toUnits(1.0f, 0.0f), 0u);
  EXPECT_TRUE(std::isnan(inr::cuda::GradientUnit(0x7f800000u, 5).toGradient(3)));
}

/// Batches of which only a piece at a time goes through the network, the last one a smaller one.
TEST(TrainingPlan, DividesWhatIsLarge)
{
  inr::Description description = SmallDescription();
  description.network.neurons = 520;
  description.network.hiddenLayers = 40;
  const inr::cuda::TrainingPlan large({description, 16384, 1, std::nullopt},
                                      std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(large.pieceSize, 1024);
  EXPECT_EQ(large.shardSize, 1024);
  EXPECT_EQ(large.shards, 1);
  GivenBatches batches(1300);
  EmulatedTrainer trainer;
  TrainPair whole(SmallDescription(), trainer, batches);
  trainer.change = [](inr::cuda::TrainingPlan& plan) {
    EXPECT_EQ(plan.pieceSize, 1300);
    EXPECT_EQ(plan.shards, 11);
    plan.pieceSize = 256;
    plan.shardSize = 128;
    plan.shards = 2;
  };
  TrainPair pieces(SmallDescription(), trainer, batches);
  for (int k = 0; k < 2; ++k) { // the sums of a step are not those of the next
    const double loss = whole.stepOnDevice(batches);
    EXPECT_NEAR(pieces.stepOnDevice(batches), loss, 1e-6 * loss);
    EXPECT_LT(RelativeError(pieces.ofDevice().first, whole.ofDevice().first), 1e-5);
  }
}

/// Without room for the volume it is left where it is, and without room for the rest none begins.
TEST(TrainingPlan, SharesOutTheMemory)
{
  const Field<float> field = WaveField();
  const inr::TrainingTask task{SmallDescription(), 16384, 1,
                               inr::NormalisedVolume{field.data(), -1, 1}};
  const std::int64_t much = std::int64_t{1} << 40;
  const inr::cuda::TrainingPlan roomy(task, much);
  EXPECT_TRUE(roomy.holdsVolume);
  const auto voxels = static_cast<std::int64_t>(field.values.size());
  const inr::cuda::TrainingPlan tight(task, roomy.bytes - 1);
  EXPECT_FALSE(tight.holdsVolume);
  EXPECT_EQ(tight.bytes, roomy.bytes - 4 * voxels);
  EXPECT_TRUE(inr::cuda::TrainingPlan(task, roomy.bytes).holdsVolume);
  try {
    const inr::cuda::TrainingPlan none(task, tight.bytes - 1);
    ADD_FAILURE() << "fits";
  } catch (const inr::Error& error) {
    EXPECT_EQ(error.code(), inr::ErrorCode::Device);
    EXPECT_NE(std::string(error.what()).find("MiB"), std::string::npos) << error.what();
  }
}

} // namespace test::training
