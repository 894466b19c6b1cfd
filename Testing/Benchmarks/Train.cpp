// SPDX-License-Identifier: BSD-3-Clause
//
// Saves a volume as the writer does by default.
//
//   bench_train VOXELS.raw TYPE NX NY NZ STEPS RATIO MODEL.inr
//
// prints one JSON object about the file. rate_distortion.py and random_access.py run it.
#include "Core/Model/ModelFile.h"
#include "Core/Training/Trainer.h"
#include "Testing/Benchmarks/RawVolume.h"

#include <filesystem>
#include <iostream>

namespace {

void Train(const RawVolume& volume, std::uint64_t steps, double ratio, const char* path)
{
  inr::TrainingOptions options;
  options.maximumSteps = steps;
  options.timeLimit = 0;
  options.targetRatio = ratio;
  const inr::ModelPointer model = inr::TrainModel(volume.data(), {}, options);
  inr::WriteModel(*model, path);
  const inr::Quality quality = model->quality.value();
  std::cout << R"({"ratio": )"
            << static_cast<double>(volume.bytes()) /
                   static_cast<double>(std::filesystem::file_size(path))
            << R"(, "psnr": )" << quality.psnr << R"(, "ssim": )" << quality.ssim
            << R"(, "error": )" << quality.maxError / (model->volume.high - model->volume.low)
            << R"(, "parameters": )" << model->parameters.size() << R"(, "seconds": )"
            << model->training.value().seconds << "}" << std::endl;
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 9) {
    std::cerr << "usage: bench_train VOXELS.raw TYPE NX NY NZ STEPS RATIO MODEL.inr\n";
    return 2;
  }
  try {
    Train(RawVolume(argv + 1), std::stoull(argv[6]), std::stod(argv[7]), argv[8]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
