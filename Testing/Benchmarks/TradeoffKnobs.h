// SPDX-License-Identifier: BSD-3-Clause
//
// The settings that bench_tradeoff tries, and the records it writes.
#pragma once

#include "Core/Image/Flip.h"
#include "Core/Image/Metrics.h"
#include "Core/Inference/InferenceKernels.h"
#include "Testing/Benchmarks/FrameScenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

constexpr double EqualPictures = 200; ///< dB, that stand for infinity

/// Writes two pictures for a metric that is not ours, where INR_PICTURES names a folder for them;
/// returns the file's path, or nothing. perceptual.py reads it.
inline std::string KeepPictures(const inr::Image& reference, const inr::Image& picture)
{
  static int number = 0;
  const char* const folder = std::getenv("INR_PICTURES");
  if (folder == nullptr || reference.channels != 4) {
    return {};
  }
  const std::string path = std::string(folder) + "/" + std::to_string(++number);
  std::ofstream file(path, std::ios::binary);
  const std::int32_t size[] = {reference.width, reference.height};
  file.write(reinterpret_cast<const char*>(size), sizeof(size));
  for (const inr::Image* image : {&reference, &picture}) {
    file.write(reinterpret_cast<const char*>(image->pixels.data()),
               static_cast<std::streamsize>(image->pixels.size() * sizeof(float)));
  }
  return path;
}

/// One line of JSON.
class Record
{
public:
  explicit Record(const std::string& name)
  {
    this->Text.precision(7);
    this->Text << "{\"name\": \"" << name << "\"";
  }
  /// What is not finite is left out.
  Record& add(const std::string& key, double value)
  {
    if (std::isfinite(value)) {
      this->Text << ", \"" << key << "\": " << value;
    }
    return *this;
  }
  Record& add(const std::string& key, const std::string& value)
  {
    this->Text << ", \"" << key << "\": \"" << value << "\"";
    return *this;
  }
  /// How far a picture is from another.
  Record& compare(const std::string& with, const inr::Image& reference, const inr::Image& picture)
  {
    this->add("psnr_" + with, std::min(EqualPictures, inr::ImagePsnr(reference, picture)));
    this->add("ssim_" + with, inr::ImageSsim(reference, picture));
    this->add("flip_" + with, inr::ImageFlip(reference, picture));
    const std::string pictures = KeepPictures(reference, picture);
    if (!pictures.empty()) {
      this->add("pictures_" + with, pictures);
    }
    return this->add("max_" + with, inr::ImageMaximumError(reference, picture));
  }
  void print() const { std::cout << this->Text.str() << "}" << std::endl; }

private:
  std::ostringstream Text;
};

/// What to render with; the rest is as by default.
struct Point
{
  std::string knob;
  std::string setting;
  inr::RendererOptions options;
  inr::Frame frame;
  bool fromEmpty; ///< whether how the cache is filled depends on it
};

inline std::string Text(double number)
{
  std::ostringstream text;
  text << number;
  return text.str();
}

inline std::string Name(inr::CachePrecision precision)
{
  return std::to_string(8 * inr::BytesPerVoxel(precision)) + " bit";
}

/// Settings by default but for one.
class SingleKnobs
{
public:
  explicit SingleKnobs(const inr::Frame& frame) : Frame(frame) {}
  std::vector<Point> points;

  /// `turn` changes the point that is as by default.
  template <typename Function>
  void add(const std::string& knob, const std::string& setting, bool fromEmpty,
           const Function& turn)
  {
    Point point{knob, setting, Cached(), this->Frame, fromEmpty};
    turn(point);
    this->points.push_back(point);
  }

private:
  inr::Frame Frame;
};

/// What changes the picture, and the one by default.
inline std::vector<Point> PictureKnobs(const inr::Frame& frame)
{
  SingleKnobs knobs(frame);
  knobs.add("defaults", "", true, [](Point&) {});
  for (const double scale : {0.0, 0.5, 1.5, 2.0, 4.0}) {
    knobs.add("LevelOfDetailScale", Text(scale), true,
              [&](Point& point) { point.frame.levelOfDetailScale = scale; });
  }
  for (const auto precision : {inr::CachePrecision::Float32, inr::CachePrecision::Bits8}) {
    knobs.add("CachePrecision", Name(precision), true,
              [&](Point& point) { point.options.cache.precision = precision; });
  }
  for (const double step : {0.25, 1.0, 2.0, 4.0}) {
    knobs.add("SampleDistance", Text(step), false,
              [&](Point& point) { point.frame.sampleDistance = step; });
  }
  knobs.add("AdaptiveSampling", "off", false,
            [](Point& point) { point.frame.adaptiveSampling = false; });
  knobs.add("CacheMode", "network only", false, [](Point& point) { point.options.cached = false; });
  return knobs.points;
}

/// What the network may compute with.
struct Numbers
{
  std::string name;
  inr::InferencePrecision precision;
};
/// Those that are rounded, as far as this machine has them.
inline std::vector<Numbers> RoundedNumbers()
{
  std::vector<Numbers> all = {{"bfloat16", inr::InferencePrecision::BFloat16}};
  if (inr::IsTileKernelUsable()) {
    all.push_back({"split bfloat16", inr::InferencePrecision::SplitBFloat16});
  }
  return all;
}

/// What the network computes with, where it fills the cache and where it is asked for each sample.
inline std::vector<Point> InferenceKnob(const inr::Frame& frame)
{
  SingleKnobs knobs(frame);
  for (const Numbers& numbers : RoundedNumbers()) {
    for (const bool cached : {true, false}) {
      knobs.add("InferencePrecision", numbers.name + (cached ? "" : ", network only"), cached,
                [&](Point& point) {
                  point.options.inference = numbers.precision;
                  point.options.cached = cached;
                });
    }
  }
  return knobs.points;
}

/// What takes the place of level of detail, in 255ths of a channel of the picture with all samples,
/// half a voxel apart.
inline std::vector<Point> ToleranceKnob(const inr::Frame& frame)
{
  SingleKnobs knobs(frame);
  for (const double tolerance : {0.0, 1.0, 4.0, 16.0}) {
    knobs.add("ErrorTolerance", Text(tolerance), true, [&](Point& point) {
      point.options = Unrounded();
      point.frame.errorTolerance = tolerance;
    });
  }
  return knobs.points;
}

/// What changes how bricks come into the cache; `wanted`: bytes of those that the view wants.
inline std::vector<Point> LoadingKnobs(const inr::Frame& frame, std::int64_t wanted)
{
  SingleKnobs knobs(frame);
  for (const int size : {16, 24, 64}) {
    knobs.add("BrickSize", Text(size), true,
              [&](Point& point) { point.options.cache.brickSize = size; });
  }
  for (const int requests : {8, 200}) {
    knobs.add("MaximumRequests", Text(requests), true,
              [&](Point& point) { point.options.cache.maximumRequests = requests; });
  }
  knobs.add("PriorityRanking", "off", true,
            [](Point& point) { point.options.cache.ranking = false; });
  knobs.add("Preloading", "off", true,
            [](Point& point) { point.options.cache.preloading = false; });
  for (const int part : {2, 8}) {
    const std::string size = "1/" + std::to_string(part) + " of what the view wants";
    knobs.add("CacheSize", size, true,
              [&](Point& point) { point.options.cache.bytes = wanted / part; });
    knobs.add("CacheMode", "cache only, " + size, true, [&](Point& point) {
      point.options.cache.bytes = wanted / part;
      point.options.cache.onlyWhatFits = true;
    });
  }
  return knobs.points;
}

/// Level of detail times step times precision.
inline std::vector<Point> Grid(const inr::Frame& frame)
{
  std::vector<Point> points;
  for (const auto precision : {inr::CachePrecision::Bits16, inr::CachePrecision::Bits8}) {
    for (const double scale : {0.5, 1.0, 2.0}) {
      for (const double step : {0.25, 0.5, 1.0, 2.0}) {
        Point point{"grid", "scale " + Text(scale) + " step " + Text(step) + " " + Name(precision),
                    Cached(), frame, false};
        point.options.cache.precision = precision;
        point.frame.levelOfDetailScale = scale;
        point.frame.sampleDistance = step;
        points.push_back(point);
      }
    }
  }
  return points;
}
