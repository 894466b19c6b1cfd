// SPDX-License-Identifier: BSD-3-Clause
//
// Our training and upstream's on one volume, with equally many samples and about as many
// parameters.
//
//   bench_recipes VOXELS.raw TYPE NX NY NZ SAMPLES
//
// prints one JSON object: the parameters and the PSNR of ours, at the default size, and of the next
// larger ones of upstream's two example models. recipes.py writes the result file.
#include "Core/Training/Quality/Quality.h"
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

/// instantvnr's second example: 8 levels of 4 features from 4^3 on, 32 x 4.
inr::Description SecondDescription()
{
  inr::Description description;
  description.grid.levels = 8;
  description.grid.features = 4;
  description.grid.baseResolution = 4;
  description.network.neurons = 32;
  description.network.hiddenLayers = 4;
  return description;
}

/// The model with the smallest table that gives at least `parameters`.
inr::Description NextLarger(inr::Description description, std::uint64_t parameters)
{
  description.grid.log2HashmapSize = 6;
  while (inr::Layout(description).parameterCount < parameters) {
    ++description.grid.log2HashmapSize;
  }
  return description;
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
  const auto train = [&](const inr::Description& description) {
    return TrainUpstream(volume, NextLarger(description, ours.parameters), samples);
  };
  std::cout << R"({"ours": )" << ours << R"(, "upstream": {"8 features from 16^3 on": )"
            << train(DefaultDescription()) << R"(, "4 features from 4^3 on": )"
            << train(SecondDescription()) << "}}" << std::endl;
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
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
