// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Paths/PathTracer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/TileLoop.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

/// What is known of an expectation.
struct Estimate
{
  double mean;
  double error; ///< standard

  double z(double truth) const { return (this->mean - truth) / this->error; }
};

/// Means beyond this many standard errors are taken for wrong. Seeds are fixed, so a test that
/// passes once passes always; over other seeds the fewer than 60 comparisons that use it would
/// raise a false alarm with a probability below 60 * 5.8e-7 = 3.5e-5.
constexpr double Unlikely = 5.0;

/// A field, a medium and its lights, to be traced.
struct PathTest
{
  PathTest(const glm::i64vec3& size, FieldEvaluator::Function function,
           const inr::TransferFunction& medium, const inr::MacroCells& cells = {})
      : dims(size), field(std::move(function)), colors(medium, VolumeOf(size)), majorants(cells)
  {
    this->majorants.update(this->colors, this->arena);
  }

  /// One path per pixel, in square tiles of `edge`.
  inr::Image picture(std::uint64_t frameIndex, int edge = inr::Tiling::Edge)
  {
    this->frame.frameIndex = frameIndex;
    const inr::RayGeometry geometry(this->frame, this->dims);
    const inr::PathTracer tracer(this->frame, geometry, this->dims, this->majorants,
                                 this->colors.lookup());
    inr::Image rgba(this->frame.width, this->frame.height, 4);
    const int columns = (rgba.width + edge - 1) / edge;
    const int rows = (rgba.height + edge - 1) / edge;
    std::vector<inr::FrameStatistics> tiles(static_cast<std::size_t>(columns) * rows);
    inr::ForEachTile(this->arena, columns * rows, {}, [&](std::int64_t k) {
      const int x = static_cast<int>(k % columns) * edge;
      const int y = static_cast<int>(k / columns) * edge;
      inr::EvaluatorSampler sampler(this->field, this->dims);
      tiles[static_cast<std::size_t>(k)] = tracer.trace(
          {x, y, std::min(edge, rgba.width - x), std::min(edge, rgba.height - y)}, sampler, rgba);
    });
    this->statistics = {};
    for (const inr::FrameStatistics& tile : tiles) {
      this->statistics.samples += tile.samples;
      this->statistics.clamped += tile.clamped;
    }
    return rgba;
  }

  /// Of the mean over the picture, from `frames` pictures.
  Estimate estimate(int channel, int frames)
  {
    double sum = 0;
    double squares = 0;
    double count = 0;
    for (int k = 0; k < frames; ++k) {
      const inr::Image image = this->picture(static_cast<std::uint64_t>(k));
      for (std::size_t i = static_cast<std::size_t>(channel); i < image.pixels.size(); i += 4) {
        sum += image.pixels[i];
        squares += static_cast<double>(image.pixels[i]) * image.pixels[i];
        ++count;
      }
    }
    const double mean = sum / count;
    return {mean, std::sqrt((squares / count - mean * mean) / count)};
  }

  PathTest(const PathTest&) = delete;
  PathTest& operator=(const PathTest&) = delete;

  glm::i64vec3 dims;
  FieldEvaluator field;
  inr::ColorTable colors;
  inr::Arena arena{2};
  inr::Majorants majorants;
  inr::Frame frame = ParallelFrame(32, {4, 4}, {12, 12}, -10, 50);
  inr::PathOptions& options = frame.paths;
  std::vector<inr::Light>& lights = frame.lights;
  inr::FrameStatistics statistics; ///< of the last picture
};

inline float Constant(const glm::vec3& /*u*/) { return 0.5f; }
