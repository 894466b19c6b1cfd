// SPDX-License-Identifier: BSD-3-Clause
//
// What it saves to start the training of a time step from the parameters of the one before.
//
//   bench_warm_start VOXELS.raw TYPE NX NY NZ VOXELS_PER_STEP STEPS_BEFORE STEPS...
//
// The volume moves: step k of the series is the volume warped by k * VOXELS_PER_STEP voxels at
// most, along waves that differ from place to place. The model of step 0 is trained for
// STEPS_BEFORE steps. Prints one JSON object: the PSNR of step 1 after so many STEPS, "cold" from
// random parameters, "warm" from those of step 0, and "chain", step 3 through a warm step 2, too.
// warm_start.py writes the result file.
#include "Core/Parallel.h"
#include "Core/Training/Samples/SampleSource.h"
#include "Core/Training/Trainer.h"
#include "Testing/Benchmarks/RawVolume.h"

#include <glm/common.hpp>

#include <cmath>
#include <iostream>

namespace {

/// A time step as floats.
class Step
{
public:
  Step(const inr::VolumeData& still, double displacement) : Values(still.voxels())
  {
    const inr::InMemorySource source(still, 0, 1);
    const glm::dvec3 dims(still.dims);
    inr::Arena().forEachBlock(still.voxels(), 1 << 14, [&](std::int64_t begin, std::int64_t end) {
      std::vector<glm::vec3> positions;
      for (std::int64_t k = begin; k < end; ++k) {
        const glm::i64vec3 voxel(k % still.dims.x, k / still.dims.x % still.dims.y,
                                 k / still.dims.x / still.dims.y);
        positions.emplace_back(Warped((glm::dvec3(voxel) + 0.5) / dims, displacement / dims));
      }
      source.sample(positions.data(), end - begin, &this->Values[begin]);
    });
    this->Data.values = this->Values.data();
    this->Data.type = inr::ScalarType::Float32;
    this->Data.dims = still.dims;
  }
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  const inr::VolumeData& data() const { return this->Data; }

private:
  static glm::dvec3 Warped(const glm::dvec3& u, const glm::dvec3& most)
  {
    const auto wave = [](double a, double b) { return std::sin(7 * a + 1) * std::cos(5 * b); };
    const glm::dvec3 direction(wave(u.y, u.z), wave(u.z, u.x), wave(u.x, u.y));
    return glm::clamp(u + most * direction, 0.0, 1.0);
  }

  std::vector<float> Values;
  inr::VolumeData Data;
};

inr::ModelPointer Train(const Step& step, std::uint64_t steps, const inr::ModelPointer& start)
{
  inr::TrainingOptions options;
  options.maximumSteps = steps;
  options.timeLimit = 0;
  options.start = start;
  return inr::TrainModel(step.data(), {}, options);
}

void Measure(const inr::VolumeData& still, double displacement, char** counts, int number)
{
  const Step first(still, 0);
  const Step second(still, displacement);
  const Step third(still, 2 * displacement);
  const Step fourth(still, 3 * displacement);
  const inr::ModelPointer start = Train(first, std::stoull(counts[0]), nullptr);
  std::cout << R"({"before": )" << start->quality.value().psnr << R"(, "after": [)";
  for (int k = 1; k < number; ++k) {
    const std::uint64_t steps = std::stoull(counts[k]);
    const inr::ModelPointer cold = Train(second, steps, nullptr);
    const inr::ModelPointer warm = Train(second, steps, start);
    const inr::ModelPointer chain = Train(fourth, steps, Train(third, steps, warm));
    std::cout << (k > 1 ? ", " : "") << R"({"steps": )" << steps << R"(, "cold": )"
              << cold->quality.value().psnr << R"(, "warm": )" << warm->quality.value().psnr
              << R"(, "chain": )" << chain->quality.value().psnr << "}" << std::flush;
  }
  std::cout << "]}" << std::endl;
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc < 9) {
    std::cerr << "usage: bench_warm_start VOXELS.raw TYPE NX NY NZ VOXELS_PER_STEP STEPS_BEFORE "
                 "STEPS...\n";
    return 2;
  }
  try {
    Measure(RawVolume(argv + 1).data(), std::stod(argv[6]), argv + 7, argc - 7);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
