// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/FrameCheck.h"

#include "Core/Error.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace inr {

namespace {

/// Keeps a ray's lattice of samples within 64 bits for any volume.
constexpr double SmallestStep = 1e-3;
constexpr double LargestStep = 1e6;
constexpr std::int64_t MaximumPixels = std::int64_t{1} << 28;

bool IsFinite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool IsNonNegative(const glm::dvec3& v) { return IsFinite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; }

void CheckSize(const Frame& frame)
{
  Require(frame.width > 0 && frame.height > 0, "a picture needs at least one pixel");
  if (std::int64_t{frame.width} * frame.height > MaximumPixels) {
    throw Error(ErrorCode::TooLarge, "a picture of " + std::to_string(frame.width) + " x " +
                                         std::to_string(frame.height) +
                                         " pixels; render it in tiles of at most 2^28");
  }
}

/// See HaveSameBits for why they, too, have to be numbers.
void CheckPlanes(const std::vector<glm::dvec4>& planes, const char* message)
{
  Require(std::all_of(planes.begin(), planes.end(),
                      [](const glm::dvec4& plane) {
                        return IsFinite(glm::dvec3(plane)) && std::isfinite(plane.w);
                      }),
          message);
}

void CheckSampling(const Frame& frame)
{
  Require(std::isfinite(frame.unitDistance) && frame.unitDistance > 0,
          "the opacity unit distance must be above 0");
  Require(frame.sampleDistance >= SmallestStep && frame.sampleDistance <= LargestStep,
          "the sample distance must be between 1/1000 and 1,000,000 voxels");
  Require(!frame.errorTolerance ||
              (*frame.errorTolerance >= 0 && std::isfinite(*frame.errorTolerance)),
          "the error tolerance must be a number, and not negative");
  Require(frame.levelOfDetailScale >= 0 && std::isfinite(frame.levelOfDetailScale),
          "the level-of-detail scale must be finite and not negative");
  Require(frame.timeLimit >= 0, "the time limit must not be negative");
  Require(frame.sharedBy >= 1, "the time limit must be shared by a picture at least");
}

void CheckModes(const Frame& frame)
{
  Require(frame.mode == RenderMode::RayMarching || frame.mode == RenderMode::PathTracing,
          "a frame's mode must be one of RenderMode's");
  Require(frame.blending.mode >= BlendMode::Composite &&
              frame.blending.mode <= BlendMode::Isosurface,
          "a frame's blend mode must be one of BlendMode's");
}

void Check(const Blending& blending, RenderMode mode)
{
  Require(mode == RenderMode::RayMarching || blending.mode == BlendMode::Composite,
          "paths are composited; choose ray marching for another blend mode");
  Require(!std::isnan(blending.averageLow) && !std::isnan(blending.averageHigh),
          "the range of averaged values must consist of numbers");
  Require(std::all_of(blending.isosurfaces.begin(), blending.isosurfaces.end(),
                      [](double value) { return std::isfinite(value); }),
          "the values of isosurfaces must be finite");
}

void Check(const Cropping& cropping, RenderMode mode)
{
  Require(!glm::any(glm::isnan(cropping.low)) && !glm::any(glm::isnan(cropping.high)),
          "cropping planes must be at numbers");
  Require(mode == RenderMode::RayMarching || BoxOf(cropping).full,
          "paths can be cropped to a box of regions only");
}

void Check(const Material& material)
{
  for (const float part :
       {material.ambient, material.diffuse, material.specular, material.specularPower}) {
    Require(part >= 0 && std::isfinite(part),
            "ambient, diffuse, specular and specular power must be finite and not negative");
  }
}

void Check(const PathOptions& options)
{
  Require(options.maximumBounces >= 0, "the number of bounces must not be negative");
  Require(options.rouletteAfter >= 0, "Russian roulette cannot begin before the first bounce");
  Require(options.scatteringAlbedo >= 0 && options.scatteringAlbedo <= 1,
          "the scattering albedo must be in [0, 1]");
  Require(std::abs(options.anisotropy) < 1, "the anisotropy must be inside (-1, 1)");
  Require(IsNonNegative(options.ambientLight), "the ambient light must be finite, not negative");
}

void Check(const Light& light)
{
  // Of all that it is compared by, whether its kind has a use for it or not.
  Require(IsFinite(light.position) && IsFinite(light.direction) && IsFinite(light.color) &&
              IsFinite(light.attenuation) && std::isfinite(light.coneAngle) &&
              std::isfinite(light.exponent),
          "a light's position, direction, colour, attenuation, cone angle and exponent must be "
          "finite");
  Require(IsNonNegative(light.color), "a light's colour must not be negative");
  if (light.kind != LightKind::Point) {
    Require(glm::length(light.direction) > 0, "a light must shine into some direction");
  }
  if (light.kind != LightKind::Directional) {
    Require(IsNonNegative(light.attenuation) && glm::length(light.attenuation) > 0,
            "a light's attenuation must not be negative, and not 0 altogether");
  }
  if (light.kind == LightKind::Spot) {
    Require(light.coneAngle > 0 && light.coneAngle <= 90,
            "a spot light's cone angle must be above 0 and at most 90 degrees");
    Require(light.exponent >= 0, "a spot light's exponent must not be negative");
  }
}

void Check(const TranslucentLayers& layers, const Frame& frame)
{
  Require(!frame.blending.projects(),
          "a projection has no depth at which to meet translucent layers; leave them out");
  Require(
      layers.fits(std::int64_t{frame.width} * frame.height),
      "translucent layers need a depth and a colour for each pixel, each behind the one before");
}

} // namespace

void RequireValid(const Frame& frame)
{
  const bool traces = frame.mode == RenderMode::PathTracing;
  CheckModes(frame);
  CheckSize(frame);
  CheckSampling(frame);
  CheckPlanes(frame.clippingPlanes, "clipping planes must consist of finite numbers");
  CheckPlanes(frame.piece, "the planes of a piece must consist of finite numbers");
  Check(frame.blending, frame.mode);
  if (frame.cropping) {
    Check(*frame.cropping, frame.mode);
  }
  if (frame.shading) {
    Check(*frame.shading);
  }
  if (traces) {
    Require(frame.samplesPerPixel >= 1, "path tracing takes at least one sample per pixel");
    Check(frame.paths);
  }
  if (traces || (frame.shading && !frame.blending.projects())) {
    for (const Light& light : frame.lights) {
      Check(light);
    }
  }
  if (frame.layers) {
    Check(*frame.layers, frame);
  }
}

} // namespace inr
