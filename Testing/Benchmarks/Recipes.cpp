// SPDX-License-Identifier: BSD-3-Clause
//
// Our training and upstream's on one volume, with equally many samples and about as many
// parameters.
//
//   bench_recipes VOXELS.raw TYPE NX NY NZ SAMPLES
//
// prints one JSON object: the parameters and the PSNR of ours, at the default size, and of
// upstream's next larger model with 8 and with 2 features a level. recipes.py writes the result
// file.
#include "Core/Training/Quality.h"
#include "Testing/Benchmarks/Models.h"
#include "Testing/Benchmarks/RawVolume.h"
#include "Testing/Benchmarks/UpstreamRecipe.h"

#include <Imath/half.h>

#include <iostream>

namespace {

/// What a training came to.
struct Outcome
{
  std::uint64_t parameters;
  double psnr;
};

std::ostream& operator<<(std::ostream& stream, const Outcome& outcome)
{
  return stream << R"({"parameters": )" << outcome.parameters << R"(, "psnr": )" << outcome.psnr
                << "}";
}

Outcome TrainOurs(const inr::VolumeData& volume, std::uint64_t samples)
{
  inr::TrainingOptions options;
  options.maximumSteps = samples / inr::BatchSize;
  options.timeLimit = 0;
  options.storedAs = inr::ParameterType::Half;
  const inr::ModelPointer model = inr::TrainModel(volume, {}, options);
  return {model->parameters.size(), model->quality.value().psnr};
}

/// Upstream's default model with fewer features or another size of table.
inr::Description UpstreamDescription(int features, int log2Size)
{
  inr::Description description = DefaultDescription();
  description.grid.features = features;
  description.grid.log2HashmapSize = log2Size;
  return description;
}

/// The smallest one that has at least `parameters`.
inr::Description NextLarger(int features, std::uint64_t parameters)
{
  int log2Size = 6;
  while (inr::Layout(UpstreamDescription(features, log2Size)).parameterCount < parameters) {
    ++log2Size;
  }
  return UpstreamDescription(features, log2Size);
}

Outcome TrainUpstream(const inr::VolumeData& volume, const inr::Description& description,
                      std::uint64_t samples)
{
  const inr::Arena arena;
  const inr::InstructionSet set = inr::ChooseInstructionSet("");
  const inr::VolumeStatistics range = inr::MeasureVolume(volume, arena);
  const inr::InMemorySource source(volume, range.low, range.high);
  auto model = std::make_shared<inr::Model>();
  model->description = description;
  model->volume.dims = volume.dims;
  model->volume.low = range.low;
  model->volume.high = range.high;
  UpstreamRecipe recipe(description, set, arena);
  for (std::uint64_t step = 0; step < samples / UpstreamRecipe::Batch; ++step) {
    recipe.step(source);
  }
  for (const float parameter : recipe.parameters()) {
    model->parameters.push_back(static_cast<float>(Imath::half(parameter)));
  }
  const inr::DecodedReport report =
      inr::MeasureQuality(*inr::MakeEvaluator(model), volume, model->volume,
                          inr::DefaultMacroCellSize(volume.dims), arena, {});
  return {model->parameters.size(), report.quality.psnr};
}

void Compare(const inr::VolumeData& volume, std::uint64_t samples)
{
  const Outcome ours = TrainOurs(volume, samples);
  std::cout << R"({"ours": )" << ours << R"(, "upstream": {"8": )"
            << TrainUpstream(volume, NextLarger(8, ours.parameters), samples) << R"(, "2": )"
            << TrainUpstream(volume, NextLarger(2, ours.parameters), samples) << "}}" << std::endl;
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 7) {
    std::cerr << "usage: bench_recipes VOXELS.raw TYPE NX NY NZ SAMPLES\n";
    return 2;
  }
  try {
    Compare(RawVolume(argv + 1).data(), std::stoull(argv[6]));
  } catch (const inr::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
