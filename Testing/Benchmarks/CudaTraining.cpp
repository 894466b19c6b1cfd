// SPDX-License-Identifier: BSD-3-Clause
//
// Samples a second that trainings take on this machine's GPU, from wherever they come, and on the
// CPU:
//
//   bench_cuda_training
//
// prints one JSON object per line; cuda.py writes the result file. Ends with status 77 where there
// is no GPU, and says why.
#include "CUDA/CudaTrainer.h"
#include "Core/Error.h"
#include "Core/Training/Samples/BatchSource.h"
#include "Testing/Benchmarks/Models.h"
#include "Testing/Core/Training/FieldReader.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <functional>
#include <iostream>

namespace {

constexpr int NoGpu = 77;
constexpr std::uint64_t WarmUp = 20; ///< steps that do not count

/// A GPU that is told of no volume in memory: the host draws its samples.
class WithoutVolume : public inr::TrainingAccelerator
{
public:
  explicit WithoutVolume(std::shared_ptr<const inr::TrainingAccelerator> inner)
      : Inner(std::move(inner))
  {}
  std::string name() const override { return this->Inner->name(); }
  std::string kernel() const override { return this->Inner->kernel(); }
  std::unique_ptr<inr::AcceleratedTraining> start(const inr::TrainingTask& task) const override
  {
    inr::TrainingTask other = task;
    other.volume.reset();
    return this->Inner->start(other);
  }

private:
  std::shared_ptr<const inr::TrainingAccelerator> Inner;
};

/// Watches a training for so many steps, then stops it.
class Watch
{
public:
  Watch(std::uint64_t steps, bool onGpu) : Last(steps), OnGpu(onGpu) {}

  bool operator()(const inr::TrainingProgress& now)
  {
    if (now.phase != inr::TrainingPhase::Training) {
      return true;
    }
    if (now.steps > 1 && now.accelerated != this->OnGpu) {
      throw inr::Error(inr::ErrorCode::Device, "the GPU does not train");
    }
    const auto time = std::chrono::steady_clock::now();
    if (now.steps >= WarmUp && this->First == 0) { // not told of each step
      this->First = now.steps;
      this->Begin = time;
    }
    const std::chrono::duration<double> passed = time - this->Begin;
    this->Rate = static_cast<double>((now.steps - this->First) * inr::BatchSize) / passed.count();
    return now.steps < this->Last;
  }
  double rate() const { return this->Rate; }

private:
  std::uint64_t Last;
  bool OnGpu;
  std::uint64_t First = 0; ///< steps when the clock was started
  std::chrono::steady_clock::time_point Begin;
  double Rate = 0;
};

/// Samples a second of a training that `train` begins.
double RateOf(const std::function<void(const inr::TrainingObserver&)>& train, std::uint64_t steps,
              bool onGpu)
{
  Watch watch(steps, onGpu);
  try {
    train([&](const inr::TrainingProgress& now) { return watch(now); });
  } catch (const inr::Error& error) {
    if (error.code() != inr::ErrorCode::Cancelled) {
      throw;
    }
  }
  return watch.rate();
}

double Report(const std::string& name, double rate, const std::string& baseline = "",
              double ofBaseline = 0)
{
  nlohmann::json line = {
      {"name", name}, {"value", rate / 1e6}, {"unit", "M samples/s"}, {"better", "higher"}};
  std::cout << line << std::endl;
  if (ofBaseline > 0) {
    line = {{"name", name + " of the CPU's"},
            {"value", rate / ofBaseline},
            {"unit", ""},
            {"better", "higher"},
            {"baseline", baseline}};
    std::cout << line << std::endl;
  }
  return rate;
}

void Bench(const std::shared_ptr<const inr::TrainingAccelerator>& gpu)
{
  const Field<float> field = WaveField<float>(glm::i64vec3(256), inr::ScalarType::Float32, -1, 1);
  inr::TrainingOptions options = Steps(100000);
  options.description = ChosenDescription();
  const auto inMemory = [&](const inr::TrainingObserver& observer) {
    inr::TrainModel(field.data(), {}, options, observer);
  };
  const auto inPieces = [&](const inr::TrainingObserver& observer) {
    FieldReader<float> reader(field);
    inr::TrainModel(reader, {}, options, observer);
  };
  const std::string cpu = "training, CPU";
  const double ofCpu = Report(cpu, RateOf(inMemory, 120, false));
  options.acceleration.accelerator = gpu;
  Report("training, GPU, from device memory", RateOf(inMemory, 4020, true), cpu, ofCpu);
  options.acceleration.accelerator = std::make_shared<WithoutVolume>(gpu);
  Report("training, GPU, from host memory", RateOf(inMemory, 2020, true), cpu, ofCpu);
  Report("training, GPU, from storage", RateOf(inPieces, 2020, true), cpu, ofCpu);
}

} // namespace

int main()
{
  try {
    const inr::cuda::FoundTrainer found = inr::cuda::FindTrainer(0);
    if (!found.accelerator) {
      std::cerr << found.reason << "\n";
      return NoGpu;
    }
    Bench(found.accelerator);
    return 0;
  } catch (const inr::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
