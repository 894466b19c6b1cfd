// SPDX-License-Identifier: BSD-3-Clause
//
// Samples per second of inference and training, by kernel and number of threads. Run with
// --benchmark_format=json through kernels.py, which writes the result file.
#include "Testing/Core/Kernels.h"

#include "Core/Inference/Evaluator.h"
#include "Core/Training/GradientDescent.h"
#include "Core/Training/Trainer.h"
#include "Testing/Core/RandomModel.h"

#include <benchmark/benchmark.h>

namespace {

/// instantvnr's default model: 8 levels of 8 features, 64 x 4; 23 M parameters.
inr::Description DefaultDescription()
{
  inr::Description description;
  description.grid.levels = 8;
  description.grid.features = 8;
  description.network.neurons = 64;
  description.network.hiddenLayers = 4;
  return description;
}

/// What the writer chooses for 256^3 bytes.
inr::Description ChosenDescription()
{
  return inr::ChooseDescription({256, 256, 256}, inr::ScalarType::UInt8, 0);
}

void Inference(benchmark::State& state, const inr::Description& description,
               const std::string& kernel, int threads)
{
  const auto evaluator = inr::MakeEvaluator(RandomModel(description), kernel);
  const inr::Arena arena(threads);
  const std::vector<glm::vec3> positions = RandomPositions(1 << 17);
  std::vector<float> values(positions.size());
  for (auto _ : state) {
    inr::EvaluateParallel(*evaluator, arena, positions.data(),
                          static_cast<std::int64_t>(positions.size()), values.data());
    benchmark::DoNotOptimize(values.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(positions.size()));
}

/// Bricks of 40^3 samples at a spacing of 1/256, each on one thread.
void Bricks(benchmark::State& state, const inr::Description& description, const std::string& kernel,
            int threads)
{
  constexpr std::int64_t edge = 40;
  const auto evaluator = inr::MakeEvaluator(RandomModel(description), kernel);
  const inr::Arena arena(threads);
  for (auto _ : state) {
    arena.forEachBlock(threads, 1, [&](std::int64_t brick, std::int64_t) {
      std::vector<float> axes[3];
      for (std::vector<float>& axis : axes) {
        for (std::int64_t k = 0; k < edge; ++k) {
          axis.push_back((static_cast<float>(brick * edge + k) + 0.5f) / 256.0f);
        }
      }
      std::vector<float> values(edge * edge * edge);
      evaluator->evaluateGrid(axes, values.data());
      benchmark::DoNotOptimize(values.data());
    });
  }
  state.SetItemsProcessed(state.iterations() * threads * edge * edge * edge);
}

/// A linear field: costs nothing beside the training step.
class Ramp : public inr::SampleSource
{
public:
  const glm::i64vec3& dims() const override { return this->Dims; }
  void sample(const glm::vec3* positions, std::int64_t count, float* targets) const override
  {
    for (std::int64_t k = 0; k < count; ++k) {
      targets[k] = positions[k].x;
    }
  }

private:
  glm::i64vec3 Dims{256};
};

void Training(benchmark::State& state, const inr::Description& description,
              const std::string& kernel, int threads)
{
  const inr::Arena arena(threads);
  inr::GradientDescent descent(description, 1, inr::ChooseInstructionSet(kernel), arena);
  const Ramp source;
  for (auto _ : state) {
    descent.step(source);
  }
  state.SetItemsProcessed(state.iterations() * inr::BatchSize);
}

using Benchmark = void (*)(benchmark::State&, const inr::Description&, const std::string&, int);

void Register(const std::string& what, Benchmark function)
{
  for (const auto& [model, description] :
       {std::pair{"default model", DefaultDescription()}, {"256^3 model", ChosenDescription()}}) {
    for (const std::string& kernel : UsableKernels()) {
      const std::string name = what + ", " + model + ", " + kernel;
      benchmark::RegisterBenchmark((name + ", 1 thread").c_str(), function, description, kernel, 1)
          ->UseRealTime();
      benchmark::RegisterBenchmark((name + ", all threads").c_str(), function, description, kernel,
                                   inr::AvailableCores())
          ->UseRealTime();
    }
  }
}

[[maybe_unused]] const bool Registered = [] {
  Register("inference", Inference);
  Register("brick inference", Bricks);
  Register("training", Training);
  return true;
}();

} // namespace
