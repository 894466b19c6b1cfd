// SPDX-License-Identifier: BSD-3-Clause
//
// Our side of against_pytorch.py: one model, timed when asked, so that both sides take turns.
//
//   bench_against_pytorch default|chosen THREADS FOLDER
//
// writes what the other side needs into FOLDER (little-endian float32: positions and values of both
// kinds of inference; a training step's batch, and the parameters before and after it; the model
// itself as a file) and one line about it to standard output. Then each line on standard input
// ("scattered", "bricks" or "training") is answered by "samples, wall seconds, processor seconds".
#include "Core/Cache/BrickSource.h"
#include "Core/Model/ModelFile.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Testing/Benchmarks/Models.h"
#include "Testing/Core/RandomModel.h"

#include <chrono>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <mutex>

namespace {

template <typename Values> void WriteNumbers(const std::string& path, const Values& values)
{
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(values[0])));
}

/// The first coordinate as a field. Remembers the positions of one batch.
class Ramp : public inr::SampleSource
{
public:
  const glm::i64vec3& dims() const override { return this->Dims; }
  void sample(const glm::vec3* positions, std::int64_t count, float* targets) const override
  {
    for (std::int64_t k = 0; k < count; ++k) {
      targets[k] = positions[k].x;
    }
    if (this->Recording) {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Pieces[positions].assign(positions, positions + count);
    }
  }

  /// What was asked for since the beginning, in the order in which it lies in memory.
  std::vector<glm::vec3> stopRecording()
  {
    std::vector<glm::vec3> batch;
    for (const auto& [address, piece] : this->Pieces) {
      batch.insert(batch.end(), piece.begin(), piece.end());
    }
    this->Recording = false;
    return batch;
  }

private:
  glm::i64vec3 Dims{256};
  bool Recording = true;
  mutable std::mutex Mutex;
  mutable std::map<const glm::vec3*, std::vector<glm::vec3>> Pieces;
};

/// Weights as at the start of a training and features all over [-1, 1]: outputs of the order of 1.
inr::ModelPointer SpreadModel(const inr::Description& description)
{
  auto model = std::make_shared<inr::Model>();
  const inr::Layout layout(description);
  model->description = description;
  model->storedAs = inr::ParameterType::Float;
  model->parameters = inr::InitialParameters(description, layout, 1);
  for (std::uint64_t k = layout.gridOffset; k < layout.parameterCount; ++k) {
    model->parameters[k] = 2.0f * inr::RandomUnit(2, k) - 1.0f;
  }
  return model;
}

std::vector<glm::vec3> VoxelsOf(const inr::Hierarchy& levels,
                                const std::vector<inr::BrickKey>& keys)
{
  std::vector<glm::vec3> positions;
  const glm::ivec3 dims = levels.brickDims();
  for (const inr::BrickKey key : keys) {
    const glm::i64vec3 first = levels.firstVoxel(inr::IdOf(key));
    for (int z = 0; z < dims.z; ++z) {
      for (int y = 0; y < dims.y; ++y) {
        for (int x = 0; x < dims.x; ++x) {
          positions.emplace_back((glm::dvec3(first + glm::i64vec3(x, y, z)) + 0.5) /
                                 glm::dvec3(levels.dims()));
        }
      }
    }
  }
  return positions;
}

/// Both kinds of inference of one model.
class Inference
{
public:
  Inference(const inr::Description& description, std::int64_t size, int threads,
            const std::string& folder)
      : Threads(threads), Levels(glm::i64vec3(size), 40), Scattered(RandomPositions(1 << 17)),
        Keys(SomeBricks(this->Levels, 0, 4 * threads))
  {
    const inr::ModelPointer model = SpreadModel(description);
    inr::WriteModel(*model, folder + "/model.inr");
    this->Field = inr::MakeEvaluator(model);
    this->Bricks = inr::MakeBrickSource(this->Field, this->Levels);
    this->scattered();
    WriteNumbers(folder + "/scattered.xyz", this->Scattered);
    WriteNumbers(folder + "/scattered.values", this->Values);
    this->bricks();
    WriteNumbers(folder + "/bricks.xyz", VoxelsOf(this->Levels, this->Keys));
    WriteNumbers(folder + "/bricks.values", this->Values);
  }

  std::string kernel() const { return this->Field->kernel(); }

  /// Samples evaluated.
  std::size_t scattered()
  {
    this->Values.resize(this->Scattered.size());
    inr::EvaluateParallel(*this->Field, this->Threads, this->Scattered.data(),
                          static_cast<std::int64_t>(this->Scattered.size()), this->Values.data());
    return this->Values.size();
  }
  std::size_t bricks()
  {
    this->Values.resize(this->Keys.size() *
                        static_cast<std::size_t>(this->Levels.voxelsPerBrick()));
    this->Bricks->infer(this->Keys.data(), static_cast<std::int64_t>(this->Keys.size()),
                        this->Values.data(), this->Threads);
    return this->Values.size();
  }

private:
  inr::Arena Threads;
  inr::Hierarchy Levels;
  std::vector<glm::vec3> Scattered;
  std::vector<inr::BrickKey> Keys;
  std::shared_ptr<const inr::Evaluator> Field;
  std::shared_ptr<const inr::BrickSource> Bricks;
  std::vector<float> Values;
};

/// Steps of forward, backward and update.
class Training
{
public:
  Training(const inr::Description& description, int threads, const std::string& folder)
      : Threads(threads), Descent(description, 1, inr::ChooseInstructionSet(""), this->Threads)
  {
    WriteNumbers(folder + "/initial.parameters", this->Descent.parameters());
    this->Loss = this->Descent.step(this->Batches).value();
    WriteNumbers(folder + "/batch.xyz", this->Field.stopRecording());
    WriteNumbers(folder + "/updated.parameters", this->Descent.parameters());
  }

  double loss() const { return this->Loss; } ///< of the first step

  std::size_t step()
  {
    this->Descent.step(this->Batches);
    return inr::BatchSize;
  }

private:
  inr::Arena Threads;
  Ramp Field;
  inr::StratifiedBatches Batches{this->Field};
  inr::GradientDescent Descent;
  double Loss = 0;
};

/// Runs `work` for a while and says how much was done in how much time.
void Time(const std::function<std::size_t()>& work)
{
  constexpr double longEnough = 0.5;
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  double wall = 0;
  std::size_t done = 0;
  while (wall < longEnough) {
    done += work();
    wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::cout << done << ' ' << wall << ' '
            << static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC << std::endl;
}

/// Prepares FOLDER, then answers lines until there are no more.
void Serve(bool chosen, int threads, const std::string& folder)
{
  const inr::Description description = chosen ? ChosenDescription() : DefaultDescription();
  Inference inference(description, chosen ? 256 : 4096, threads, folder);
  Training training(description, threads, folder);
  std::cout << R"({"kernel": ")" << inference.kernel() << R"(", "loss": )" << training.loss()
            << R"(, "learning_rate": )" << inr::LearningRate().initial << "}" << std::endl;
  const std::map<std::string, std::function<std::size_t()>> rounds = {
      {"scattered", [&] { return inference.scattered(); }},
      {"bricks", [&] { return inference.bricks(); }},
      {"training", [&] { return training.step(); }}};
  for (std::string line; std::getline(std::cin, line);) {
    Time(rounds.at(line));
  }
}

} // namespace

int main(int argc, char* argv[])
{
  const std::string which = argc == 4 ? argv[1] : "";
  if (which != "default" && which != "chosen") {
    std::cerr << "usage: bench_against_pytorch default|chosen THREADS FOLDER\n";
    return 2;
  }
  try {
    Serve(which == "chosen", std::stoi(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
