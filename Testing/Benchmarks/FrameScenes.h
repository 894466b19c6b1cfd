// SPDX-License-Identifier: BSD-3-Clause
//
// The scenes that the frame benchmarks share, and how they report.
#pragma once

#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

constexpr int Threads = 2;
constexpr int Size = 512;

struct Look
{
  std::string name;
  inr::TransferFunction function;
};

/// Opacity at fractions of the value range, linear in between; colour from blue to red.
inline inr::TransferFunction MakeFunction(const inr::VolumeInfo& volume,
                                          const std::vector<std::pair<float, float>>& opacity)
{
  inr::TransferFunction function;
  function.low = volume.low;
  function.high = volume.high;
  for (int k = 0; k < 1024; ++k) {
    const float x = static_cast<float>(k) / 1023;
    std::size_t next = 1;
    while (next + 1 < opacity.size() && opacity[next].first < x) {
      ++next;
    }
    const auto& [x0, a0] = opacity[next - 1];
    const auto& [x1, a1] = opacity[next];
    function.table.emplace_back(x, 0.5f, 1 - x, a0 + (a1 - a0) * (x - x0) / (x1 - x0));
  }
  return function;
}

inline std::vector<Look> Looks(const inr::VolumeInfo& volume)
{
  return {{"sparse", MakeFunction(volume, {{0, 0}, {0.55f, 0}, {0.65f, 0.3f}, {0.75f, 0}, {1, 0}})},
          {"dense", MakeFunction(volume, {{0, 0.02f}, {0.5f, 0.1f}, {1, 0.3f}})}};
}

/// The whole volume, turned by `degrees` about y; opacities refer to two voxels of 256 per axis.
inline inr::Frame View(const inr::VolumeInfo& volume, double degrees = 30)
{
  const glm::dvec3 extent(volume.dims);
  const double reach = extent.x;
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0, 1, 0));
  const glm::dvec3 eye = 0.5 * extent + glm::dvec3(turn * glm::dvec4(0, 0.8, 2.0, 0)) * reach;
  inr::Frame frame;
  frame.width = frame.height = Size;
  frame.clipToWorld =
      glm::inverse(glm::perspective(glm::radians(35.0), 1.0, 0.3 * reach, 5 * reach) *
                   glm::lookAt(eye, 0.5 * extent, glm::dvec3(0, 1, 0)));
  frame.sampleDistance = 1;
  frame.unitDistance = 2 * reach / 256;
  return frame;
}

/// The same for path tracing, with a headlight and some light from everywhere.
inline inr::Frame Lit(inr::Frame frame)
{
  frame.mode = inr::RenderMode::PathTracing;
  frame.paths.ambientLight = glm::vec3(0.5f);
  inr::Light light;
  const glm::dvec4 from = frame.clipToWorld * glm::dvec4(0, 0, -1, 1);
  const glm::dvec4 to = frame.clipToWorld * glm::dvec4(0, 0, 1, 1);
  light.direction = glm::dvec3(to) / to.w - glm::dvec3(from) / from.w;
  frame.lights = {light};
  return frame;
}

inline void Report(const std::string& name, double value, const std::string& unit,
                   const std::string& better, const std::string& more = "")
{
  std::cout << "{\"name\": \"" << name << "\", \"value\": " << value << ", \"unit\": \"" << unit
            << "\", \"better\": \"" << better << "\"" << more << "}" << std::endl;
}

inline std::string Target(double target, const std::string& baseline = "")
{
  std::ostringstream text;
  text << ", \"target\": " << target;
  if (!baseline.empty()) {
    text << ", \"baseline\": \"" << baseline << "\"";
  }
  return text.str();
}

/// As ParaView has it by default.
inline inr::RendererOptions Cached()
{
  inr::RendererOptions options;
  options.threads = Threads;
  options.inference.reset();
  options.cache.bytes = std::int64_t{4} << 30;
  return options;
}

/// With nothing rounded that the network computes with, as with an ErrorTolerance.
inline inr::RendererOptions Unrounded()
{
  inr::RendererOptions options = Cached();
  options.inference = inr::InferencePrecision::Float32;
  return options;
}

/// The model as that of a volume of `dims` voxels.
inline inr::ModelPointer Scaled(const inr::ModelPointer& model, const glm::i64vec3& dims)
{
  auto scaled = std::make_shared<inr::Model>(*model);
  scaled->nativeDims = model->volume.dims;
  scaled->volume.dims = dims;
  return scaled;
}

struct Timed
{
  double seconds; ///< median
  inr::Image picture;
  inr::FrameStatistics statistics;
};

inline Timed Median(inr::Renderer& renderer, const inr::Frame& frame, int frames)
{
  Timed timed;
  std::vector<double> times;
  for (int k = 0; k < frames; ++k) {
    timed.statistics = renderer.render(frame, timed.picture);
    times.push_back(timed.statistics.seconds);
  }
  std::sort(times.begin(), times.end());
  timed.seconds = times[times.size() / 2];
  return timed;
}
