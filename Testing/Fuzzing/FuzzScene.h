// SPDX-License-Identifier: BSD-3-Clause
//
// A small scene from a few bytes: every number near the ends of its range at times, and none that
// asks for more than a moment's work.
#pragma once

#include "Core/Error.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Renderer.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

constexpr std::size_t SceneSize = 64;

/// Reads numbers off the bytes, and zeros behind their end.
class SceneBytes
{
public:
  explicit SceneBytes(const std::uint8_t* bytes) : Bytes(bytes) {}

  std::uint8_t next() { return this->At < SceneSize ? this->Bytes[this->At++] : 0; }
  int below(int end) { return this->next() % end; }
  double unit() { return this->next() / 255.0; }                                 ///< [0, 1]
  double signedUnit() { return this->next() / 127.5 - 1.0; }                     ///< [-1, 1]
  double power(int range) { return std::pow(10.0, range * this->signedUnit()); } ///< 10^(+-range)

private:
  const std::uint8_t* Bytes;
  std::size_t At = 0;
};

struct FuzzScene
{
  inr::RendererOptions options;
  inr::TransferFunction colors;
  inr::Frame frame;
  bool quick = false; ///< rays are of a bearable number of samples
};

namespace fuzz_scene {

inline glm::dmat4 IndexToWorld(const inr::VolumeInfo& volume)
{
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), volume.origin);
  return glm::scale(moved * glm::dmat4(volume.direction), volume.spacing);
}

inline inr::RendererOptions Options(SceneBytes& bytes)
{
  inr::RendererOptions options;
  options.threads = 1;
  options.cached = bytes.below(8) != 0;
  options.deterministic = bytes.below(4) != 0;
  options.cache.precision = static_cast<inr::CachePrecision>(bytes.below(3));
  options.cache.brickSize = 4 + bytes.below(16);
  options.cache.bytes = std::int64_t{1} << (18 + bytes.below(6));
  options.cache.maximumRequests = 1 + bytes.below(40);
  options.cache.ranking = bytes.below(2) == 0;
  options.cache.preloading = bytes.below(2) == 0;
  options.cache.onlyWhatFits = bytes.below(2) == 0;
  return options;
}

inline inr::TransferFunction Colors(const inr::VolumeInfo& volume, SceneBytes& bytes)
{
  inr::TransferFunction colors;
  const double width = volume.high - volume.low;
  colors.low = volume.low + width * 0.2 * bytes.signedUnit();
  colors.high = volume.high + width * 0.2 * bytes.signedUnit();
  colors.logarithmic = bytes.below(8) == 0;
  for (int entries = 2 + bytes.below(6); entries > 0; --entries) {
    const auto tone = static_cast<float>(bytes.unit());
    const int form = bytes.below(4);
    const float alpha = form == 0 ? 0.0f : (form == 1 ? 1.0f : static_cast<float>(bytes.unit()));
    colors.table.emplace_back(tone, 1.0f - tone, 0.5f, form == 2 ? 1e-7f * alpha : alpha);
  }
  return colors;
}

/// Looks at a point in the volume from anywhere around it or inside.
inline void Look(const inr::VolumeInfo& volume, SceneBytes& bytes, inr::Frame& frame)
{
  const glm::dmat4 indexToWorld = IndexToWorld(volume);
  const glm::dvec3 last = glm::dvec3(volume.dims) - 1.0;
  const glm::dvec3 centre(indexToWorld * glm::dvec4(0.5 * last, 1.0));
  const double radius = 0.5 * glm::length(glm::max(last, 1.0) * volume.spacing);
  glm::dvec3 from(bytes.signedUnit(), bytes.signedUnit(), bytes.signedUnit());
  from = bytes.below(8) == 0 ? glm::dvec3(0, 0, 1) : from + glm::dvec3(0, 0, 1e-3);
  const double distance = radius * bytes.power(3);
  const glm::dvec3 eye = centre + glm::normalize(from) * distance;
  const glm::dmat4 view = glm::lookAt(eye, centre, glm::dvec3(0.1, 1.0, 0.0));
  const double near = std::max(distance - 1.1 * radius, 1e-3 * distance);
  const double angle = glm::radians(0.01 + 178.0 * bytes.unit());
  const glm::dmat4 projection =
      bytes.below(4) == 0
          ? glm::ortho(-radius, radius, -radius, radius, near, distance + 1.1 * radius)
          : glm::perspective(angle, 1.0, near, distance + 1.1 * radius);
  frame.width = 1 + bytes.below(12);
  frame.height = 1 + bytes.below(12);
  frame.clipToWorld = glm::inverse(projection * view);
  frame.worldToIndex = glm::inverse(indexToWorld);
}

/// How many samples the longest ray has; not the file's spacing says so but the matrix, which far
/// from the origin is what doubles have left of it.
inline double MostSamples(const inr::VolumeInfo& volume, const inr::Frame& frame)
{
  try {
    const inr::RayGeometry geometry(frame, volume.dims);
    return geometry.longest() / frame.sampleDistance;
  } catch (const inr::Error&) {
    return 0; // refused, and quickly
  }
}

/// The longest way through the volume in voxels of its densest axis.
inline double LongestRay(const inr::VolumeInfo& volume)
{
  const glm::dvec3 edges = glm::abs(volume.spacing);
  const double shortest = std::min({edges.x, edges.y, edges.z});
  return glm::length(glm::dvec3(volume.dims) * (edges / shortest));
}

/// None for bytes that are not there; now and then what is refused.
inline std::optional<double> Tolerance(SceneBytes& bytes)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  switch (bytes.below(16)) {
  case 1:
    return 0.0;
  case 2:
    return infinity;
  case 3:
    return 1e-300;
  case 4:
    return bytes.below(2) == 0 ? -1.0 : nan;
  case 5:
  case 6:
  case 7:
  case 8:
    return 8.0 * bytes.power(3);
  default:
    return std::nullopt;
  }
}

inline void Kind(const inr::VolumeInfo& volume, SceneBytes& bytes, inr::Frame& frame)
{
  const int kind = bytes.below(10);
  frame.mode = kind < 3 ? inr::RenderMode::PathTracing : inr::RenderMode::RayMarching;
  if (kind >= 5) {
    frame.blending.mode = static_cast<inr::BlendMode>(kind - 4);
    for (int k = 0; k < 2; ++k) {
      frame.blending.isosurfaces.push_back(inr::ValueOf(volume, static_cast<float>(bytes.unit())));
    }
    frame.blending.averageLow = bytes.below(2) == 0 ? volume.low : frame.blending.averageLow;
  }
  if (bytes.below(2) == 0) {
    frame.shading.emplace();
  }
  frame.lights.emplace_back();
  frame.lights[0].kind = static_cast<inr::LightKind>(bytes.below(3));
  frame.lights[0].position = volume.origin + bytes.signedUnit() * 1e3 * volume.spacing;
  frame.paths.maximumBounces = bytes.below(5);
  frame.paths.scatteringAlbedo = static_cast<float>(bytes.unit());
  frame.paths.anisotropy = 0.99 * bytes.signedUnit();
  frame.paths.emissionOnly = bytes.below(4) == 0;
  frame.samplesPerPixel = 1 + bytes.below(3);
}

} // namespace fuzz_scene

inline FuzzScene MakeFuzzScene(const inr::VolumeInfo& volume, SceneBytes& bytes)
{
  FuzzScene scene;
  inr::Frame& frame = scene.frame;
  scene.options = fuzz_scene::Options(bytes);
  scene.colors = fuzz_scene::Colors(volume, bytes);
  fuzz_scene::Look(volume, bytes, frame);
  fuzz_scene::Kind(volume, bytes, frame);

  constexpr double mostSteps = 200;
  const double longest = fuzz_scene::LongestRay(volume);
  frame.sampleDistance = std::max(bytes.power(2), longest / mostSteps);
  const int sampling = bytes.below(4);
  frame.adaptiveSampling = sampling % 2 == 0;
  frame.preIntegration = sampling >= 2;
  // Full resolution everywhere costs a brick for every few samples.
  frame.levelOfDetailScale = longest > 200 ? bytes.power(1) + 1 : bytes.below(3);
  const glm::dvec3 edges = glm::abs(volume.spacing);
  const double length = longest * std::min({edges.x, edges.y, edges.z});
  frame.unitDistance =
      length * std::max(bytes.power(6), 1e-2); // optical depths of hundreds at most
  frame.timeLimit = bytes.below(3) == 0 ? 0.02 : 0;
  if (bytes.below(4) == 0) {
    frame.cropping.emplace();
    frame.cropping->low = glm::dvec3(volume.dims) * 0.3;
    frame.cropping->high = glm::dvec3(volume.dims) * 0.3 * bytes.unit() + frame.cropping->low;
    frame.cropping->flags = bytes.next() * 0x10101u & 0x7ffffffu;
  }
  frame.seed = bytes.next();
  frame.errorTolerance = fuzz_scene::Tolerance(bytes);
  switch (bytes.below(4)) {
  case 1:
    scene.options.inference = inr::InferencePrecision::BFloat16;
    break;
  case 2:
    scene.options.inference = inr::InferencePrecision::SplitBFloat16;
    break;
  default:
    break;
  }
  scene.quick =
      frame.sampleDistance <= 1e6 && fuzz_scene::MostSamples(volume, frame) <= 2 * mostSteps;
  return scene;
}
