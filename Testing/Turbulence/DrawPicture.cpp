// SPDX-License-Identifier: BSD-3-Clause
//
// Draws the field itself, without any model or voxel, as the renderer draws a model of it, and
// compares a picture with that. Prints one JSON object.
#include "Core/Error.h"
#include "Core/Image/Exr.h"
#include "Core/Image/Flip.h"
#include "Core/Image/Metrics.h"
#include "Testing/Turbulence/ChannelOptions.h"
#include "Testing/Turbulence/ChannelPicture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>

namespace {

constexpr const char* Usage =
    "usage: channel_picture SCENE.json FIELD.exr [--compare PICTURE.exr] [--beside BOTH.ppm]\n"
    "                       [--threads 0] [--seed 1] [--octaves 6] [--intensity 0.06] [--time 0]\n"
    "Draws the field that the last options name into FIELD.exr; SCENE.json is described in\n"
    "ChannelPicture.h. --beside: the picture compared, and that of the field to its right, over\n"
    "black.\n";

std::string TextOf(const std::string& path)
{
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) {
    throw inr::Error(inr::ErrorCode::CannotRead, "cannot read '" + path + "'");
  }
  return text;
}

unsigned char ByteOf(float value)
{
  return static_cast<unsigned char>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

void WriteBeside(const std::string& path, const inr::Image& left, const inr::Image& right)
{
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << left.width + right.width << " " << left.height << "\n255\n";
  for (int y = left.height - 1; y >= 0; --y) {
    for (const inr::Image* image : {&left, &right}) {
      for (int x = 0; x < image->width; ++x) {
        for (int channel = 0; channel < 3; ++channel) {
          file.put(static_cast<char>(ByteOf(image->pixel(x, y)[channel])));
        }
      }
    }
  }
  if (!file.flush()) {
    throw inr::Error(inr::ErrorCode::CannotWrite, "cannot write '" + path + "'");
  }
}

/// Of the rays that took samples, if that was written: how many, and of which level of resolution.
void TellCounts(const inr::Image& counts, nlohmann::ordered_json& result)
{
  double rays = 0;
  double samples = 0;
  double levels = 0;
  for (std::size_t k = 0; k < counts.pixels.size(); k += 2) {
    if (counts.pixels[k] > 0) {
      ++rays;
      samples += static_cast<double>(counts.pixels[k]);
      levels += static_cast<double>(counts.pixels[k + 1]);
    }
  }
  if (rays > 0) {
    result["mean_samples"] = samples / rays;
    result["mean_level"] = levels / rays;
  }
}

void Compare(const inr::Options& options, const inr::Image& truth, nlohmann::ordered_json& result)
{
  const std::string path = options.text("--compare", "");
  if (path.empty()) {
    return;
  }
  inr::Image counts;
  const inr::Image picture = inr::ReadExr(path, nullptr, &counts);
  result["psnr"] = inr::ImagePsnr(truth, picture);
  result["ssim"] = inr::ImageSsim(truth, picture);
  result["flip"] = inr::ImageFlip(truth, picture);
  result["max_error"] = inr::ImageMaximumError(truth, picture);
  TellCounts(counts, result);
  const std::string beside = options.text("--beside", "");
  if (!beside.empty()) {
    WriteBeside(beside, picture, truth);
  }
}

void Draw(const inr::Options& options)
{
  if (options.positional().size() != 2) {
    throw inr::Error(inr::ErrorCode::InvalidArgument, "name a scene and a picture to write");
  }
  const inr::TurbulentChannel field(inr::FieldFrom(options));
  const inr::ChannelScene scene = inr::ParseChannelScene(TextOf(options.positional()[0]));
  const inr::Arena arena(static_cast<int>(options.integer("--threads", 0)));
  const auto start = std::chrono::steady_clock::now();
  std::int64_t samples = 0;
  const inr::Image truth = inr::DrawChannel(field, scene, arena, &samples);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  inr::WriteExr(options.positional()[1], truth);
  nlohmann::ordered_json result;
  result["samples"] = samples;
  result["seconds"] = seconds.count();
  Compare(options, truth, result);
  std::cout << result.dump(2) << std::endl;
}

} // namespace

int main(int argc, char** argv)
{
  return inr::RunProgram(argc, argv, Usage, {"--compare", "--beside", "--threads"}, Draw);
}
