// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/ModelFile.h"
#include "Core/Model/Quantised.h"
#include "Core/Random.h"
#include "Core/Training/Quantise.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <limits>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>
#include <unistd.h>

namespace test::quantise {

const inr::EvaluateKernel& FastestKernel()
{
  return inr::EvaluateKernelFor(inr::ChooseInstructionSet(""));
}

/// What a network that was trained on a field is quantised with.
struct Quantising : testing::Test
{
  Quantising() { this->train(SmallDescription()); }

  void train(const inr::Description& description)
  {
    inr::TrainingOptions options = Steps(200);
    options.storedAs = inr::ParameterType::Half;
    options.description = description;
    this->Trained = *inr::TrainModel(this->Data.data(), {}, options);
  }

  void quantise(inr::Model& model, inr::QuantiseLimits limits = {}) const
  {
    inr::Quantise(model, this->Estimate, this->kernel(), limits);
  }

  double psnr(const inr::Model& model) const
  {
    const inr::Layout layout(model.description);
    const inr::ModelViewStorage views(model.description, layout, model.parameters.data());
    return this->Estimate.measure(views.view(), this->kernel(), inr::StopCheck());
  }

  static const inr::EvaluateKernel& kernel() { return FastestKernel(); }

  Field<float> Data = WaveField();
  inr::InMemorySource Source{this->Data.data(), -1, 1};
  inr::Arena Threads{2};
  inr::PsnrEstimate Estimate{this->Source, 1, this->Threads, 1 << 13}; ///< of 8,160 voxels
  inr::Model Trained;
};

TEST_F(Quantising, LosesWhatItMayAndNoLess)
{
  for (const double loss : {0.1, 1.0}) {
    inr::Model model = this->Trained;
    this->quantise(model, {loss, 0});
    EXPECT_EQ(model.storedAs, inr::ParameterType::Quantised);
    const double lost = this->psnr(this->Trained) - this->psnr(model);
    EXPECT_LE(lost, loss + 1e-6);
    EXPECT_GT(lost, loss / 2);
  }
}

TEST_F(Quantising, GivesWhatAFileGivesBack)
{
  inr::Model model = this->Trained;
  this->quantise(model);
  const std::string path = (std::filesystem::path(testing::TempDir()) /
                            ("quantise-" + std::to_string(getpid()) + ".inr"))
                               .string();
  inr::WriteModel(model, path);
  const inr::ModelPointer read = inr::ReadModel(path);
  std::filesystem::remove(path);
  EXPECT_EQ(read->parameters, model.parameters);
  EXPECT_EQ(read->steps, model.steps);
}

// A level's parameters matter less the more of them there are.
TEST_F(Quantising, GivesFineLevelsCoarserSteps)
{
  inr::Model model = this->Trained;
  this->quantise(model);
  const std::size_t matrices = inr::Layout(model.description).layers.size();
  EXPECT_GT(model.steps.back(), 1.5f * model.steps[matrices]);
}

TEST_F(Quantising, HalvesTheFile)
{
  inr::Model model = this->Trained;
  this->quantise(model);
  constexpr std::int64_t header = 2000; // the same in both
  EXPECT_LT(2 * (inr::ModelFileSize(model) - header), inr::ModelFileSize(this->Trained) - header);
}

// Features a million times as small under weights a million times as large are the same network.
TEST_F(Quantising, DoesNotDependOnTheScaleOfFeatures)
{
  inr::Model model = this->Trained;
  this->quantise(model);
  for (const float scale : {0x1p-60f, 0x1p50f}) {
    inr::Model scaled = this->Trained;
    const inr::Layout layout(scaled.description);
    const inr::LayerShape& first = layout.layers.front();
    for (int k = 0; k < first.rows * first.columns; ++k) {
      scaled.parameters[first.offset + static_cast<std::uint64_t>(k)] /= scale;
    }
    for (std::uint64_t k = layout.gridOffset; k < layout.parameterCount; ++k) {
      scaled.parameters[k] *= scale;
    }
    this->quantise(scaled);
    EXPECT_EQ(scaled.steps[0], model.steps[0] / scale);
    EXPECT_EQ(scaled.steps.back(), model.steps.back() * scale);
    EXPECT_EQ(scaled.parameters.back(), model.parameters.back() * scale);
  }
}

TEST_F(Quantising, TakesGroupsOfZerosAndOfEqualNumbers)
{
  inr::Model model = this->Trained;
  const std::vector<inr::ParameterGroup> groups = inr::ParameterGroups(model.description);
  const auto fill = [&](std::size_t group, float value) {
    std::fill_n(model.parameters.begin() + static_cast<std::ptrdiff_t>(groups[group].offset),
                groups[group].count, value);
  };
  fill(groups.size() - 1, 0.0f);
  fill(groups.size() - 2, 0.25f);
  inr::Model zeros = this->Trained;
  std::fill(zeros.parameters.begin(), zeros.parameters.end(), 0.0f);
  for (inr::Model* each : {&model, &zeros}) {
    const double before = this->psnr(*each);
    this->quantise(*each);
    EXPECT_EQ(each->storedAs, inr::ParameterType::Quantised);
    EXPECT_GT(this->psnr(*each), before - 0.1001);
    EXPECT_GT(inr::ModelFileSize(*each), 0); // throws where a step is none
  }
}

TEST_F(Quantising, ClearsWhatNothingDependsOn)
{
  inr::Model model = this->Trained;
  model.description.network.alignment = 16;
  this->quantise(model);
  const inr::LayerShape last = inr::Layout(model.description).layers.back();
  ASSERT_EQ(last.rows, 16);
  const float* weights = model.parameters.data() + last.offset;
  EXPECT_NE(std::accumulate(weights, weights + last.columns, 0.0f), 0.0f);
  EXPECT_TRUE(std::all_of(weights + last.columns, weights + 16 * last.columns,
                          [](float weight) { return weight == 0; }));
}

// One number that dwarfs its level leaves no step for the others; here nothing reads it.
TEST_F(Quantising, StaysInHalvesWhereSixteenBitsAreTooFew)
{
  inr::Description description = SmallDescription();
  description.grid.baseResolution = 5; // 125 of 128 entries
  this->train(description);
  inr::Model model = this->Trained;
  model.parameters[inr::Layout(model.description).gridOffset + 127 * 4] = 3e7f;
  const double before = this->psnr(model);
  this->quantise(model);
  EXPECT_EQ(model.storedAs, inr::ParameterType::Half);
  EXPECT_TRUE(model.steps.empty());
  EXPECT_EQ(this->psnr(model), before);
}

// Whatever the steps, no voxel would say that they are too coarse.
TEST_F(Quantising, StaysInHalvesWhereNothingIsKnown)
{
  constexpr std::int64_t count = 1 << 13;
  std::vector<float> targets(count, NAN);
  targets[5] = 0.5f;
  const inr::PsnrEstimate estimate(inr::PsnrEstimate::positions(this->Data.dims, 1, count), targets,
                                   this->Threads);
  inr::Model model = this->Trained;
  inr::Quantise(model, estimate, this->kernel(), {});
  EXPECT_EQ(model.storedAs, inr::ParameterType::Half);
  EXPECT_EQ(this->psnr(model), this->psnr(this->Trained));
}

TEST_F(Quantising, KeepsASizeAndGivesUpOnOneOutOfReach)
{
  inr::Model model = this->Trained;
  this->quantise(model);
  const std::int64_t free = inr::ModelFileSize(model);
  const std::int64_t wanted = 2000 + (free - 2000) * 3 / 4;
  inr::Model smaller = this->Trained;
  this->quantise(smaller, {0.1, wanted});
  EXPECT_LE(inr::ModelFileSize(smaller), wanted);
  EXPECT_GT(inr::ModelFileSize(smaller), wanted * 8 / 10);
  inr::Model hopeless = this->Trained;
  this->quantise(hopeless, {0.1, 100});
  EXPECT_EQ(hopeless.parameters, model.parameters);
}

TEST_F(Quantising, CanBeStopped)
{
  inr::Model model = this->Trained;
  const inr::StopCheck check([]() -> bool { throw std::runtime_error("enough"); });
  EXPECT_THROW(inr::Quantise(model, this->Estimate, this->kernel(), {}, check), std::runtime_error);
}

/// The fastest kernel, and how it was called.
struct WatchedKernel
{
  static inline std::atomic<std::int64_t> points{0};

  static void evaluate(const inr::ModelView& model, const float* xyz, std::int64_t count,
                       float* values, float* workspace)
  {
    points += count;
    FastestKernel().evaluate(model, xyz, count, values, workspace);
  }
  static inr::EvaluateKernel kernel() { return {FastestKernel().workspace, &evaluate}; }
};

TEST_F(Quantising, EvaluatesTheNetworkAFewTimesOnly)
{
  WatchedKernel::points = 0;
  inr::Model model = this->Trained;
  inr::Quantise(model, this->Estimate, WatchedKernel::kernel(), {});
  const std::int64_t groups = static_cast<std::int64_t>(model.steps.size());
  // Each group alone, the network as it was, and some of the many steps that are tried.
  EXPECT_LE(WatchedKernel::points / (1 << 13), groups + 1 + 10);
}

/// Two threads that wait until they are in it at the same time.
struct MeetingKernel
{
  static inline std::mutex mutex;
  static inline std::condition_variable met;
  static inline std::set<std::thread::id> threads;

  static void evaluate(const inr::ModelView& model, const float* xyz, std::int64_t count,
                       float* values, float* workspace)
  {
    {
      std::unique_lock<std::mutex> lock(mutex);
      threads.insert(std::this_thread::get_id());
      met.notify_all();
      met.wait_for(lock, std::chrono::seconds(10), [] { return threads.size() > 1; });
      threads.insert(std::thread::id()); // nobody waits again
    }
    FastestKernel().evaluate(model, xyz, count, values, workspace);
  }
};

TEST_F(Quantising, EvaluatesTheNetworkOnAllThreads)
{
  const inr::Layout layout(this->Trained.description);
  const inr::ModelViewStorage views(this->Trained.description, layout,
                                    this->Trained.parameters.data());
  const inr::EvaluateKernel meeting{FastestKernel().workspace, &MeetingKernel::evaluate};
  const std::vector<float> values = this->Estimate.values(views.view(), meeting, inr::StopCheck());
  MeetingKernel::threads.erase(std::thread::id());
  EXPECT_EQ(MeetingKernel::threads.size(), 2u);
  const inr::Arena alone(1);
  const inr::PsnrEstimate byOne(this->Source, 1, alone, 1 << 13);
  EXPECT_EQ(byOne.values(views.view(), this->kernel(), inr::StopCheck()), values);
}

/// Bytes of the file of a model that was trained at a ratio, over the bytes asked for.
template <class T>
double Share(const Field<T>& field, double ratio, std::uint64_t steps = 60, int macroCellSize = 0)
{
  inr::TrainingOptions options = Steps(steps);
  options.macroCellSize = macroCellSize;
  options.targetRatio = ratio;
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  const double bytes = static_cast<double>(field.values.size() * sizeof(T));
  return static_cast<double>(inr::ModelFileSize(*model)) * ratio / bytes;
}

// A smooth field is fitted so well that many digits of each parameter count.
TEST(TargetRatio, IsKeptByAGoodFit)
{
  const Field<float> field = WaveField<float>({40, 40, 40}, inr::ScalarType::Float32, 0, 1);
  for (const double ratio : {8.0, 25.0}) {
    const double share = Share(field, ratio, 1000);
    EXPECT_LE(share, 1.0) << ratio;
    EXPECT_GT(share, 0.5) << ratio;
  }
}

TEST(TargetRatio, IsKept)
{
  Field<float> noise = WaveField<float>({60, 50, 40}, inr::ScalarType::Float32, 0, 1);
  for (std::size_t k = 0; k < noise.values.size(); ++k) {
    noise.values[k] += inr::RandomUnit(5, k);
  }
  for (const double ratio : {8.0, 20.0, 40.0}) {
    const double share = Share(noise, ratio);
    EXPECT_LE(share, 1.0) << ratio;
    EXPECT_GT(share, 0.2) << ratio;
  }
}

// Ranges of small cells are packed to a part of what they are.
TEST(TargetRatio, IsUsedWithSmallCells)
{
  const Field<float> field = WaveField<float>({40, 40, 40}, inr::ScalarType::Float32, 0, 1);
  for (const auto& [edge, ratio] : {std::pair(1, 3.0), {2, 8.0}}) {
    const double share = Share(field, ratio, 200, edge);
    EXPECT_LE(share, 1.0) << edge;
    EXPECT_GT(share, 0.4) << edge;
  }
}

TEST(TargetRatio, OutOfReachCostsNoQuality)
{
  inr::TrainingOptions options = Steps(60);
  options.targetRatio = 1e6;
  const double out = inr::TrainModel(WaveField().data(), {}, options)->quality->psnr;
  options.storedAs = inr::ParameterType::Half;
  EXPECT_GT(out, inr::TrainModel(WaveField().data(), {}, options)->quality->psnr - 0.2);
}

} // namespace test::quantise
