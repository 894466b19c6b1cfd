// SPDX-License-Identifier: BSD-3-Clause
//
// The stages of path tracing, as functions over one path; a tile runs each over its live paths.
//
// Distances to collisions come from delta tracking (Woodcock et al., "Techniques used in the GEM
// code for Monte Carlo neutronics calculations", 1965) against the macro-cells' majorants, the
// transmittance towards a light from ratio tracking (Novak et al., "Residual ratio tracking for
// estimating attenuation in participating media", 2014). Both are without bias.
#pragma once

#include "Core/HostDevice.h"
#include "Core/Random.h"
#include "Core/Render/MacroCells/CellWalker.h"
#include "Core/Render/Marching/RayMarching.h"
#include "Core/Render/Paths/PathTracingField.h"
#include "Core/Render/Paths/PathTracingGeometry.h"
#include "Core/Render/Paths/PathTracingPhase.h"
#include "Core/Render/Rays/LevelOfDetail.h"
#include "Core/Render/Scene/Lights.h"
#include "Core/Render/Scene/Opacity.h"
#include "Core/Render/Scene/PathOptions.h"

#include <cmath>
#include <cstdint>

namespace inr {

/// A light and, of a directional one, what all points have in common. Plain data.
struct PathLight
{
  Light light;
  Illumination illumination;
  RayDirection towards;
};

INR_HOST_DEVICE inline PathLight MakePathLight(const InnerRays& inner, const Light& light)
{
  const Illumination everywhere =
      light.kind == LightKind::Directional ? IlluminationAt(light, {}) : Illumination{};
  return {light, everywhere, inner.along(everywhere.toLight)};
}

/// What the stages share within a frame. Plain data, whose arrays lie in the memory of whoever
/// traces; it stays where it is while paths are traced.
struct PathScene
{
  PixelStreams streams;
  RayView rays;
  InnerRays inner;
  MajorantsView majorants;
  CellScale cells; ///< of its finest grid
  ColorLookup colors;
  const PathLight* lights;
  int lightCount;
  PathOptions options;
  double levelOfDetailScale; ///< see Frame
  glm::dvec3 dims;           ///< voxels per axis
  double unitsPerT;          ///< opacity unit distances per unit of t
  int levels;                ///< that a point may be asked at, at least 1
  std::uint64_t piece;       ///< a number that the frame's piece has for itself, 0: the whole
};

INR_HOST_DEVICE inline CellWalker WalkerFor(const PathScene& scene, const Ray& ray)
{
  return {scene.majorants, scene.dims, ray, scene.levelOfDetailScale, scene.levels};
}

/// Of a pixel's path. Pictures of neighbouring pieces are multiplied when they are blended, and
/// must not come from the same numbers.
INR_HOST_DEVICE inline std::uint64_t RandomStream(const PathScene& scene, int x, int y)
{
  const std::uint64_t stream = scene.streams.at(x, y);
  return scene.piece == 0 ? stream : RandomBits(stream, scene.piece);
}

/// Where a path stands: on its way, or between a scattering and a light.
struct PathState
{
  /// At the beginning; the ray may miss the volume.
  INR_HOST_DEVICE PathState(const PathScene& scene, int x, int y)
      : ray(scene.rays.rayThroughPiece(x, y)), walker(WalkerFor(scene, ray)),
        stream(RandomStream(scene, x, y)), travel(scene.inner.worldDirection(ray.direction))
  {}

  Ray ray; ///< the one that is being followed now
  CellWalker walker;
  double t = 0;         ///< on it
  std::uint64_t stream; ///< of random numbers
  std::uint64_t drawn = 0;

  glm::dvec3 travel{0.0};         ///< world direction of the path
  glm::dvec3 vertex{0.0};         ///< point index of the last scattering
  glm::vec3 throughput{1.0f};     ///< from the camera to here
  glm::vec3 radiance{0.0f};       ///< gathered
  glm::dvec3 firstCollision{0.0}; ///< point index, once collided
  glm::vec3 fromLight{0.0f};      ///< on its way to be gathered, if nothing absorbs it
  float passed = 1;               ///< of it, so far
  double footprint = 0;           ///< of the pixel at the vertex
  int bounces = 0;
  bool collided = false;
  bool towardsLight = false;
};

/// The next random number of a path, uniform in [0, 1): SplitMix64's sequence, from a start of the
/// path's own.
INR_HOST_DEVICE inline double Draw(PathState& path)
{
  const std::uint64_t bits = MixBits(path.stream + path.drawn++ * 0x9E3779B97F4A7C15ull);
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

INR_HOST_DEVICE inline float Largest(const glm::vec3& v)
{
  return glm::max(v.x, glm::max(v.y, v.z));
}

/// Keeps something of weight `chance` <= 1 alive in proportion; 0 means that it ends, else what to
/// divide by.
INR_HOST_DEVICE inline float Roulette(PathState& path, float chance)
{
  if (chance >= 1.0f) {
    return 1.0f;
  }
  return Draw(path) < chance ? chance : 0.0f;
}

/// Sends the path from its vertex.
INR_HOST_DEVICE inline void Follow(const PathScene& scene, PathState& path,
                                   const RayDirection& direction, double limit)
{
  scene.inner.aim(path.ray, path.vertex, direction, limit);
  path.ray.footprint = path.footprint;
  path.ray.footprintGrowth = 0;
  path.walker.follow(path.ray, scene.cells);
  path.t = 0;
}

/// Sends the path on from its vertex.
INR_HOST_DEVICE inline void GoOn(const PathScene& scene, PathState& path)
{
  const double u = Draw(path);
  const double turn = Draw(path);
  const double g = scene.options.anisotropy;
  path.travel = g == 0 ? AnyDirection(u, turn) : Turn(path.travel, SamplePhaseCosine(g, u), turn);
  path.towardsLight = false;
  Follow(scene, path, scene.inner.along(path.travel), Infinite);
}

/// Sends the path towards a light; false where that gives nothing.
INR_HOST_DEVICE inline bool Illuminate(const PathScene& scene, PathState& path,
                                       const PathLight& source)
{
  const bool distant = source.light.kind == LightKind::Directional;
  const Illumination light =
      distant ? source.illumination : IlluminationAt(source.light, scene.inner.world(path.vertex));
  const double cosine = glm::dot(path.travel, light.toLight);
  const double phase = PhaseDensity(scene.options.anisotropy, cosine);
  path.fromLight =
      path.throughput * light.irradiance * static_cast<float>(phase * scene.lightCount);
  if (!(Largest(path.fromLight) > 0.0f)) {
    return false;
  }
  path.towardsLight = true;
  path.passed = 1.0f;
  Follow(scene, path, distant ? source.towards : scene.inner.along(light.toLight), light.distance);
  return true;
}

/// Sends the path towards a light, one of them all at random; or, where that gives nothing, on.
INR_HOST_DEVICE inline void LookAtLight(const PathScene& scene, PathState& path)
{
  if (scene.lightCount > 0) {
    const int chosen =
        glm::min(static_cast<int>(Draw(path) * scene.lightCount), scene.lightCount - 1);
    if (Illuminate(scene, path, scene.lights[chosen])) {
      return;
    }
  }
  GoOn(scene, path);
}

/// A place where a path may collide, and what decides whether it does.
struct PathSample
{
  ValueRange range; ///< of its macro-cell
  float majorant;   ///< extinction per opacity unit distance
};

/// Moves along the ray to its next place of possible collision; false when it leaves first.
INR_HOST_DEVICE inline bool NextCollision(const PathScene& scene, PathState& path,
                                          PathSample& sample)
{
  const double end = path.ray.length;
  double depth = -std::log(1.0 - Draw(path)); // 1 - x is exact
  while (path.t < end) {
    path.walker.moveTo(path.t);
    if (!path.walker.moveToVisible(end)) {
      return false;
    }
    const double begin = glm::max(path.t, path.walker.enter());
    sample.majorant = glm::min(path.walker.extinction(), FiniteExtinctionOf(1.0f));
    const double perT = sample.majorant * scene.unitsPerT;
    const double exit = glm::min(path.walker.exit(), end);
    if (depth < perT * (exit - begin)) {
      path.t = begin + depth / perT;
      sample.range = path.walker.range();
      return true;
    }
    depth -= glm::max(0.0, perT * (exit - begin));
    path.t = exit;
  }
  return false;
}

/// Gathers what comes from outside along the ray that has left; false when that ends the path.
INR_HOST_DEVICE inline bool Leave(const PathScene& scene, PathState& path)
{
  if (path.towardsLight) {
    path.radiance += path.fromLight * path.passed;
    GoOn(scene, path);
    return true;
  }
  if (path.collided) {
    path.radiance += path.throughput * scene.options.ambientLight;
  }
  return false;
}

/// Where the path asks for the field next; false when it has ended.
INR_HOST_DEVICE inline bool PlaceSample(const PathScene& scene, PathState& path, PathSample& sample,
                                        FieldPoint& point)
{
  while (!NextCollision(scene, path, sample)) {
    if (!Leave(scene, path)) {
      return false;
    }
  }
  LevelOfDetail detail(path.ray, scene.levelOfDetailScale, scene.levels);
  detail.moveTo(path.walker.enter());
  const int level = detail.isDithered()
                        ? detail.dithered(path.stream, static_cast<std::int64_t>(path.drawn++))
                        : detail.level();
  const glm::dvec3 inside = glm::clamp(path.ray.at(path.t), glm::dvec3(0.0), scene.dims - 1.0);
  MoveTo(point, inside, level);
  return true;
}

/// Takes from the light on its way what does not pass; false when none is left, which is also what
/// becomes, at random and without bias, of light that has become faint.
INR_HOST_DEVICE inline bool Attenuate(PathState& path, float passes)
{
  constexpr float faint = 0.1f;
  path.passed *= passes;
  if (path.passed >= faint) {
    return true;
  }
  const float chance = path.passed > 0.0f ? Roulette(path, path.passed / faint) : 0.0f;
  path.passed = faint;
  return chance > 0.0f;
}

/// A scattering at the path's place; false when the path ends there.
INR_HOST_DEVICE inline bool Scatter(const PathScene& scene, PathState& path, const glm::vec3& color)
{
  const PathOptions& options = scene.options;
  if (path.bounces >= options.maximumBounces) {
    return false;
  }
  ++path.bounces;
  path.throughput *= color * options.scatteringAlbedo;
  float chance = Largest(path.throughput);
  if (path.bounces > options.rouletteAfter && chance > 0.0f) {
    chance = Roulette(path, glm::min(chance, 1.0f));
    path.throughput /= chance > 0.0f ? chance : 1.0f;
  }
  if (!(chance > 0.0f)) {
    return false;
  }
  path.footprint = path.ray.footprint + path.ray.footprintGrowth * path.t;
  path.vertex = path.ray.at(path.t);
  LookAtLight(scene, path);
  return true;
}

/// Lets the path by where there is nothing to collide with, as Collide does.
INR_HOST_DEVICE inline void PassBy(PathState& path)
{
  if (!path.towardsLight) {
    Draw(path);
  }
}

/// Lets the path collide, or not, with what the field has at its place; false when that ends it.
INR_HOST_DEVICE inline bool Collide(const PathScene& scene, PathState& path, float majorant,
                                    float value)
{
  const glm::vec4 entry = scene.colors.at(value);
  const float share = glm::min(FiniteExtinctionOf(entry.w) / majorant, 1.0f);
  if (path.towardsLight) {
    if (share > 0.0f && !Attenuate(path, 1.0f - share)) {
      GoOn(scene, path);
    }
    return true;
  }
  if (Draw(path) >= share) {
    return true;
  }
  if (!path.collided) {
    path.collided = true;
    path.firstCollision = path.ray.at(path.t);
  }
  const glm::vec3 color(entry);
  if (scene.options.emissionOnly) {
    path.radiance += path.throughput * color;
    return false;
  }
  return Scatter(scene, path, color);
}

/// Of a path that has ended, premultiplied, as the camera sees it: through the translucent surfaces
/// in front of its first collision.
INR_HOST_DEVICE inline glm::vec4 ShownColor(const PathScene& scene, const PathState& path,
                                            std::int64_t pixel)
{
  const float alpha = path.collided ? 1.0f : 0.0f;
  if (!path.collided || !scene.rays.layers.any()) {
    return {path.radiance, alpha};
  }
  const double depth = scene.rays.windowDepth(path.firstCollision);
  const Veil veil = scene.rays.layers.inFrontOf(depth, pixel);
  return {veil.color + veil.passes * path.radiance, alpha};
}

} // namespace inr
