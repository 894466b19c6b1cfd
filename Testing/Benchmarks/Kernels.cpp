// SPDX-License-Identifier: BSD-3-Clause
//
// Samples per second of inference and training, by kernel and number of threads, and what this
// processor could do at most. Run with --benchmark_format=json through kernels.py, which writes the
// result file. INR_MODEL may name a trained model's file: its bricks are timed too.
#include "Testing/Core/Kernels.h"

#include "Core/Cache/BrickSource.h"
#include "Core/Inference/InferenceKernels.h"
#include "Core/Model/ModelFile.h"
#include "Core/Random.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Trainer.h"
#include "Testing/Benchmarks/Ceilings.h"
#include "Testing/Benchmarks/Models.h"
#include "Testing/Core/RandomModel.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>

namespace {

const std::string Rounding = " bfloat16"; ///< behind the name of a kernel
const std::string Splitting = " split bfloat16";

/// Those of UsableKernels, and such that multiply rounded numbers.
std::vector<std::string> InferenceKernels()
{
  std::vector<std::string> names = UsableKernels();
  for (const std::string& kernel : UsableKernels()) {
    if (inr::IsUsable(inr::InferencePrecision::BFloat16, inr::ChooseInstructionSet(kernel))) {
      names.push_back(kernel + Rounding);
    }
  }
  if (inr::IsTileKernelUsable()) {
    names.push_back("amx" + Rounding);
    names.push_back("amx" + Splitting);
  }
  return names;
}

std::shared_ptr<const inr::Evaluator> EvaluatorOf(inr::ModelPointer model, const std::string& name)
{
#ifdef __x86_64__
  if (name.find(Splitting) != std::string::npos) { // whatever the model: this one's values are huge
    return inr::MakeEvaluator(std::move(model), inr::SplitTileKernels());
  }
#endif
  const bool rounds = name.find(Rounding) != std::string::npos;
  return inr::MakeEvaluator(std::move(model), name.substr(0, name.find(' ')),
                            rounds ? inr::InferencePrecision::BFloat16
                                   : inr::InferencePrecision::Float32);
}

/// A random model, all of its features times `scale`.
inr::ModelPointer ScaledFeatures(const inr::Description& description, float scale)
{
  const auto model = RandomModel(description);
  for (std::size_t k = inr::Layout(description).gridOffset; k < model->parameters.size(); ++k) {
    model->parameters[k] *= scale;
  }
  return model;
}

void InferModel(benchmark::State& state, inr::ModelPointer model, const std::string& kernel,
                int threads, std::int64_t points = 1 << 17)
{
  const auto evaluator = EvaluatorOf(std::move(model), kernel);
  const inr::Arena arena(threads);
  const std::vector<glm::vec3> positions = RandomPositions(points);
  std::vector<float> values(positions.size());
  for (auto step : state) {
    inr::EvaluateParallel(*evaluator, arena, positions.data(),
                          static_cast<std::int64_t>(positions.size()), values.data());
    benchmark::DoNotOptimize(values.data());
  }
  state.counters["threads_used"] = threads;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(positions.size()));
}

void Inference(benchmark::State& state, const inr::Description& description,
               const std::string& kernel, int threads)
{
  InferModel(state, RandomModel(description), kernel, threads);
}

/// Four bricks of 40^3 voxels per thread, all over a level of a volume of size^3.
void InferBricks(benchmark::State& state, inr::ModelPointer model, const std::string& kernel,
                 int threads, std::int64_t size, int level)
{
  const inr::Hierarchy levels({size, size, size}, 40);
  const auto source = inr::MakeBrickSource(EvaluatorOf(std::move(model), kernel), levels);
  const inr::Arena arena(threads);
  const std::vector<inr::BrickKey> keys = SomeBricks(levels, level, 4 * threads);
  std::vector<float> values(keys.size() * static_cast<std::size_t>(levels.voxelsPerBrick()));
  for (auto step : state) {
    source->infer(keys.data(), static_cast<std::int64_t>(keys.size()), values.data(), arena);
    benchmark::DoNotOptimize(values.data());
  }
  state.counters["threads_used"] = threads;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(values.size()));
}

void Bricks(benchmark::State& state, const inr::Description& description, const std::string& kernel,
            int threads)
{
  InferBricks(state, RandomModel(description), kernel, threads, 256, 0);
}

/// A slice across `axis`: 512 x 512 voxels of a volume of 4096^3. Across x, a row of it is one
/// voxel.
void InferSlice(benchmark::State& state, inr::ModelPointer model, const std::string& kernel,
                int axis)
{
  const auto evaluator = EvaluatorOf(std::move(model), kernel);
  const inr::Arena arena(1);
  glm::i64vec3 size(512);
  size[axis] = 1;
  const inr::Lattice lattice = inr::VoxelLattice(glm::i64vec3(4096), glm::i64vec3(1024), size);
  std::vector<float> values(512 * 512);
  for (auto step : state) {
    inr::EvaluateLattice(*evaluator, arena, lattice, values.data());
    benchmark::DoNotOptimize(values.data());
  }
  state.counters["threads_used"] = 1;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(values.size()));
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
  inr::StratifiedBatches batches(source);
  for (auto step : state) {
    descent.step(batches);
  }
  state.SetItemsProcessed(state.iterations() * inr::BatchSize);
}

using Benchmark = void (*)(benchmark::State&, const inr::Description&, const std::string&, int);

/// `function` for both models, these kernels, and one and all threads; timed by the processor time
/// of the process, which leaves out what others do on the machine, or by the wall clock.
void Register(const std::string& what, Benchmark function, const std::vector<std::string>& kernels,
              bool wallClock)
{
  for (const auto& [model, description] :
       {std::pair{"default model", DefaultDescription()}, {"256^3 model", ChosenDescription()}}) {
    for (const std::string& kernel : kernels) {
      const std::string name = what + ", " + model + ", " + kernel;
      for (const auto& [note, threads] :
           {std::pair{", 1 thread", 1}, {", all threads", inr::AvailableCores()}}) {
        auto* const run = benchmark::RegisterBenchmark((name + note).c_str(), function, description,
                                                       kernel, threads);
        wallClock ? run->UseRealTime() : run->MeasureProcessCPUTime();
      }
    }
  }
}

/// Bricks of the finest level of a volume of 4096^3, and of the one above it, whose voxels are
/// means of eight samples.
void RegisterBricks(const std::string& what, const inr::ModelPointer& model, std::int64_t size)
{
  for (const std::string& kernel : InferenceKernels()) {
    for (const int threads : {1, inr::AvailableCores()}) {
      const std::string name =
          what + ", " + kernel + (threads == 1 ? ", 1 thread" : ", all threads");
      benchmark::RegisterBenchmark(name.c_str(), InferBricks, model, kernel, threads, size, 0)
          ->MeasureProcessCPUTime();
    }
    benchmark::RegisterBenchmark((what + " of level 1, " + kernel + ", 1 thread").c_str(),
                                 InferBricks, model, kernel, 1, size, 1)
        ->MeasureProcessCPUTime();
  }
}

void RegisterSlices()
{
  const inr::ModelPointer model = RandomModel(DefaultDescription());
  for (const std::string& kernel : InferenceKernels()) {
    for (const auto& [axis, name] : {std::pair{0, "x"}, {1, "y"}, {2, "z"}}) {
      benchmark::RegisterBenchmark(("slice of 4096^3 across " + std::string(name) +
                                    ", default model, " + kernel + ", 1 thread")
                                       .c_str(),
                                   InferSlice, model, kernel, axis)
          ->MeasureProcessCPUTime();
    }
  }
}

/// What numbers cost that processors or floats are bad at: denormal ones, and those that overflow.
void RegisterBadNumbers()
{
  for (const std::string& kernel : UsableKernels()) {
    for (const auto& [what, scale] :
         {std::pair{"denormal features", 1e-40f}, {"numbers beyond float's", 1e38f}}) {
      const std::string name = std::string("inference, ") + what + ", 256^3 model, " + kernel;
      benchmark::RegisterBenchmark((name + ", 1 thread").c_str(), InferModel,
                                   ScaledFeatures(ChosenDescription(), scale), kernel, 1, 1 << 12)
          ->MeasureProcessCPUTime();
    }
  }
}

void RegisterCeilings()
{
  for (const std::string& kernel : UsableKernels()) {
    if (const FusedOperations operations = FusedOperationsOf(kernel)) {
      benchmark::RegisterBenchmark(("ceiling, arithmetic, " + kernel).c_str(), Arithmetic,
                                   operations);
    }
  }
  benchmark::RegisterBenchmark("ceiling, loads, default model", EntryLoads);
}

[[maybe_unused]] const bool Registered = [] {
  RegisterCeilings();
  RegisterBricks("brick of 4096^3, default model", RandomModel(DefaultDescription()), 4096);
  if (const char* path = std::getenv("INR_MODEL")) {
    const inr::ModelPointer model = inr::ReadModel(path);
    RegisterBricks("brick, trained model", model, model->volume.dims.x);
  }
  Register("inference", Inference, InferenceKernels(), false);
  RegisterBadNumbers();
  RegisterSlices();
  Register("brick inference", Bricks, InferenceKernels(), false);
  Register("training", Training, UsableKernels(), true);
  return true;
}();

} // namespace
