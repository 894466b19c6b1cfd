// SPDX-License-Identifier: BSD-3-Clause
//
// Compares a model of a turbulent channel with the field itself at random voxels, which nobody has
// to have stored, and prints one JSON object.
#include "Core/Error.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Turbulence/ChannelOptions.h"
#include "Testing/Turbulence/ChannelTruth.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <iostream>

namespace {

constexpr const char* Usage =
    "usage: channel_truth MODEL.inr [--voxels 100000000] [--draw 1] [--threads 0]\n"
    "                     [--seed 1] [--octaves 6] [--intensity 0.06] [--time 0]\n"
    "The second line names the field as turbulent_channel and TurbulentChannel do; --draw is the\n"
    "seed of the random voxels.\n";

void Measure(const inr::Options& options)
{
  if (options.positional().size() != 1) {
    throw inr::Error(inr::ErrorCode::InvalidArgument, "name one model file");
  }
  const std::string path = options.positional().front();
  const inr::TurbulentChannel field(inr::FieldFrom(options));
  const inr::ModelPointer model = inr::ReadModel(path);
  const inr::Arena arena(static_cast<int>(options.integer("--threads", 0)));
  const inr::ChannelError error =
      inr::MeasureChannelError(model, field, options.integer("--voxels", 100000000),
                               static_cast<std::uint64_t>(options.integer("--draw", 1)), arena);
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  const inr::VolumeInfo& volume = model->volume;
  const double voxels = static_cast<double>(volume.dims.x) * static_cast<double>(volume.dims.y) *
                        static_cast<double>(volume.dims.z);
  nlohmann::ordered_json result;
  result["voxels"] = error.voxels;
  result["psnr"] = error.psnr;
  result["max_error"] = error.maxError;
  result["rms_error"] = error.rootMeanSquare;
  result["field_range"] = {error.low, error.high};
  result["model_range"] = {volume.low, volume.high};
  result["dims"] = {volume.dims.x, volume.dims.y, volume.dims.z};
  result["file_bytes"] = bytes;
  result["ratio"] = voxels * static_cast<double>(inr::ScalarSize(volume.type)) / bytes;
  std::cout << result.dump(2) << std::endl;
}

} // namespace

int main(int argc, char** argv)
{
  return inr::RunProgram(argc, argv, Usage, {"--voxels", "--draw", "--threads"}, Measure);
}
