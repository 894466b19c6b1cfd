// SPDX-License-Identifier: BSD-3-Clause
//
// Compresses a volume of one's own, here a torus that is computed, into a model file; no VTK.
//
//     example_core_train MODEL.inr
#include "Core/Model/ModelFile.h"
#include "Core/Training/Trainer.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

namespace {

constexpr glm::i64vec3 Dims{64, 64, 40};

/// A ring that fades from its middle, 0 to 1; x fastest.
std::vector<float> MakeTorus()
{
  std::vector<float> values;
  for (std::int64_t k = 0; k < Dims.x * Dims.y * Dims.z; ++k) {
    const glm::dvec3 voxel(k % Dims.x, k / Dims.x % Dims.y, k / (Dims.x * Dims.y));
    const glm::dvec3 p = (voxel + 0.5 - 0.5 * glm::dvec3(Dims)) / 32.0; // -1 to 1 along x and y
    const double outward = std::hypot(p.x, p.y) - 0.6;
    values.push_back(static_cast<float>(std::exp(-12.0 * (outward * outward + p.z * p.z))));
  }
  return values;
}

void Train(const char* path)
{
  const std::vector<float> values = MakeTorus();
  inr::VolumeData volume;
  volume.values = values.data();
  volume.type = inr::ScalarType::Float32;
  volume.dims = Dims;

  inr::VolumeInfo info;
  info.arrayName = "torus";
  inr::TrainingOptions options;
  options.targetPsnr = 35;
  options.maximumSteps = 400;
  options.timeLimit = 60;
  const inr::ModelPointer model = inr::TrainModel(volume, info, options);
  inr::WriteModel(*model, path);
  std::printf("%s: %.1f dB after %llu steps in %.1f s\n", path, model->quality->psnr,
              static_cast<unsigned long long>(model->training->steps), model->training->seconds);
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s MODEL.inr\n", argv[0]);
    return 2;
  }
  try {
    Train(argv[1]);
  } catch (const std::exception& error) { // inr::Error, or no memory
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
