// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes in which a tolerance is hard to keep, made at random: thin things that lie along the rays
// or nearly so, things as large as the distances of samples, noise; steep, bright and jumping
// colours.
#pragma once

#include "Core/Random.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// Random numbers that depend on a scene's number and on how many were drawn for it.
class Dice
{
public:
  Dice(std::uint64_t seed, std::uint64_t scene) : Seed(inr::RandomBits(seed, scene)) {}

  double between(double low, double high)
  {
    return low + (high - low) * static_cast<double>(inr::RandomUnit(this->Seed, this->Drawn++));
  }
  /// Evenly over the logarithm.
  double scale(double low, double high)
  {
    return std::exp(this->between(std::log(low), std::log(high)));
  }
  template <typename Value> Value oneOf(const std::vector<Value>& values)
  {
    return values[static_cast<std::size_t>(this->between(0, static_cast<double>(values.size())))];
  }
  glm::dvec3 direction()
  {
    const double z = this->between(-1, 1);
    const double turn = this->between(0, 6.283185307179586);
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(turn), across * std::sin(turn), z};
  }

private:
  std::uint64_t Seed;
  std::uint64_t Drawn = 0;
};

struct RandomHardScene
{
  std::string name;
  glm::i64vec3 dims;
  int cellEdge = 0; ///< voxels
  FieldEvaluator::Function field;
  inr::TransferFunction colours;
  glm::dvec3 along;   ///< way of parallel rays, in voxels
  double spacing = 1; ///< of z, in those of x and y
  double unitDistance = 1;
  double sampleDistance = 1;
};

/// Two directions across one, and across each other.
struct Across
{
  explicit Across(const glm::dvec3& way)
  {
    const glm::dvec3 n = glm::normalize(way);
    this->first = glm::normalize(
        glm::cross(n, std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    this->second = glm::cross(n, this->first);
  }
  glm::dvec3 first;
  glm::dvec3 second;
};

/// A value of the voxel at `at`, counted from the volume's middle.
using VoxelFunction = std::function<double(const glm::dvec3& at)>;

/// Along `way`, `thick` voxels or so thick and `apart` from each other, of values from `low` on.
inline VoxelFunction FibresOf(const glm::dvec3& way, double thick, double apart,
                              const glm::dvec2& shift, double low, double more)
{
  const Across across(way);
  return [=](const glm::dvec3& at) {
    const glm::dvec2 place =
        (glm::dvec2(glm::dot(at, across.first), glm::dot(at, across.second)) + shift) / apart;
    const glm::dvec2 off = apart * (place - glm::round(place));
    return low + more * std::exp(-glm::dot(off, off) / (thick * thick));
  };
}

inline VoxelFunction Fibres(Dice& dice, const glm::dvec3& way)
{
  const double apart = dice.scale(5, 24);
  const double thick = dice.scale(0.6, 3);
  const glm::dvec2 shift(dice.between(0, apart), dice.between(0, apart));
  return FibresOf(way, thick, apart, shift, 0.05, 0.9);
}

inline VoxelFunction Layers(Dice& dice, const glm::dvec3& normal)
{
  const double apart = dice.scale(5, 30);
  const double thick = dice.scale(0.6, 3);
  const double shift = dice.between(0, apart);
  return [=](const glm::dvec3& at) {
    const double place = (glm::dot(at, glm::normalize(normal)) + shift) / apart;
    const double off = apart * (place - std::round(place)) / thick;
    return 0.1 + 0.8 * std::exp(-off * off);
  };
}

inline VoxelFunction Ripples(Dice& dice, const glm::dvec3& way)
{
  const glm::dvec3 turns = 6.283185307179586 / dice.scale(3, 60) * glm::normalize(way);
  const double shift = dice.between(0, 6);
  return [=](const glm::dvec3& at) { return 0.5 + 0.45 * std::cos(glm::dot(turns, at) + shift); };
}

inline VoxelFunction Grains(Dice& dice)
{
  const double edge = dice.oneOf<double>({1, 1, 2, 3});
  const auto seed = static_cast<std::uint64_t>(dice.between(0, 1e6));
  return [=](const glm::dvec3& at) {
    const glm::i64vec3 grain(glm::floor(at / edge) + 1000.0);
    return static_cast<double>(inr::RandomUnit(
        seed, static_cast<std::uint64_t>(grain.x + 4096 * (grain.y + 4096 * grain.z))));
  };
}

inline VoxelFunction Checkers(Dice& dice)
{
  const double edge = dice.scale(2, 20);
  return [=](const glm::dvec3& at) {
    const glm::i64vec3 box(glm::floor(at / edge) + 1000.0);
    return (box.x + box.y + box.z) % 2 == 0 ? 0.9 : 0.1;
  };
}

inline VoxelFunction Gyroids(Dice& dice)
{
  const double turn = 6.283185307179586 / dice.scale(4, 24);
  return [=](const glm::dvec3& at) {
    const glm::dvec3 a = turn * (at + 0.5);
    return 0.5 + 0.25 * (std::sin(a.x) * std::cos(a.y) + std::sin(a.y) * std::cos(a.z) +
                         std::sin(a.z) * std::cos(a.x));
  };
}

/// Linear between voxels, as a tolerance takes fields to be.
inline FieldEvaluator::Function Between(const glm::i64vec3& dims, const VoxelFunction& valueOf)
{
  const auto voxels = std::make_shared<const Voxels>(dims, [&](const glm::vec3& u) {
    const glm::dvec3 at = glm::floor(glm::dvec3(u) * glm::dvec3(dims));
    return static_cast<float>(valueOf(at - 0.5 * glm::dvec3(dims)));
  });
  return [voxels](const glm::vec3& u) { return voxels->at(u); };
}

inline void SetField(Dice& dice, RandomHardScene& scene)
{
  const glm::dvec3 along = glm::normalize(scene.along);
  const Across across(along);
  const glm::dvec3 nearly = along + dice.oneOf<double>({0, 0.02, 0.1}) * dice.direction();
  const double turn = dice.between(0, 6.283185307179586);
  const glm::dvec3 aside = std::cos(turn) * across.first + std::sin(turn) * across.second +
                           dice.oneOf<double>({0, 0.05}) * along;
  struct Kind
  {
    const char* name;
    VoxelFunction valueOf;
  };
  const Kind kind = dice.oneOf<Kind>({{"fibres nearly end on", Fibres(dice, nearly)},
                                      {"fibres end on", Fibres(dice, along)},
                                      {"fibres end on", Fibres(dice, along)},
                                      {"fibres end on", Fibres(dice, along)},
                                      {"fibres across", Fibres(dice, aside)},
                                      {"layers along", Layers(dice, aside)},
                                      {"layers across", Layers(dice, nearly)},
                                      {"layers along", Layers(dice, aside)},
                                      {"waves along", Ripples(dice, aside)},
                                      {"waves", Ripples(dice, dice.direction())},
                                      {"grains", Grains(dice)},
                                      {"checkers", Checkers(dice)},
                                      {"checkers", Checkers(dice)},
                                      {"gyroid", Gyroids(dice)}});
  scene.name = kind.name;
  scene.field = Between(scene.dims, kind.valueOf);
}

inline void SetColours(Dice& dice, RandomHardScene& scene)
{
  const int kind = dice.oneOf<int>({0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 5});
  const double most = dice.scale(0.01, 0.3);
  const double peaks = dice.between(2, 24);
  for (int k = 0; k < 1024; ++k) {
    const double x = k / 1023.0;
    const double peak = peaks * x - std::floor(peaks * x) - 0.5;
    const glm::dvec4 entry[] = {{1, 0.5, 0.2, most * x}, // rises
                                {1 - x, 0.5, x, 1 - x},  // falls, opaque at its end
                                {20 - 20 * x, 0.2, 1, most * (0.1 + 0.9 * x)},           // bright
                                {1, 1, 1, most * std::max(0.0, 1 - 4 * std::abs(peak))}, // peaks
                                {1, 0.7, 0, x < 0.4 ? 0.1 * most : most},                // jumps
                                {x, 1 - x, 0.5, 0.5 * most}}; // colour only
    scene.colours.table.emplace_back(entry[kind]);
  }
  const char* const names[] = {"rise", "fall", "bright", "peaks", "jump", "colour"};
  scene.name += std::string(", ") + names[kind];
}

inline RandomHardScene MakeRandomHardScene(std::uint64_t seed, std::uint64_t number)
{
  Dice dice(seed, number);
  RandomHardScene scene;
  scene.cellEdge = dice.oneOf<int>({8, 16, 16, 16, 32, 64, 128});
  scene.dims = glm::i64vec3(scene.cellEdge > 32 ? 128 : 80);
  // As far from the 13 directions that are looked at as any; or one of these; or any.
  const glm::dvec3 between(1, 0.41421356, 0.31783725);
  scene.along = dice.oneOf<glm::dvec3>(
      {between, between, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}, dice.direction(), dice.direction()});
  scene.spacing = dice.oneOf<double>({1, 1, 1, 0.125, 4, 32});
  scene.unitDistance = dice.scale(4, 32);
  scene.sampleDistance = dice.oneOf<double>({0.25, 0.5, 0.5, 1});
  SetField(dice, scene);
  SetColours(dice, scene);
  return scene;
}

inline inr::Renderer RendererOf(const RandomHardScene& scene)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(scene.field), VolumeOf(scene.dims),
                         CellsOf(scene.field, scene.dims, scene.cellEdge), options);
  renderer.setTransferFunction(scene.colours);
  return renderer;
}

/// Of all of it, along parallel rays.
inline inr::Frame FrameOf(const RandomHardScene& scene, int size)
{
  const glm::dvec3 stretch(1, 1, scene.spacing);
  const glm::dvec3 middle = 0.5 * glm::dvec3(scene.dims - std::int64_t{1}) * stretch;
  const double reach = glm::length(middle);
  const glm::dvec3 way = glm::normalize(scene.along * stretch);
  inr::Frame frame;
  frame.width = frame.height = size;
  frame.sampleDistance = scene.sampleDistance;
  frame.unitDistance = scene.unitDistance * std::min(1.0, scene.spacing);
  frame.worldToIndex = glm::scale(glm::dmat4(1.0), 1.0 / stretch);
  frame.clipToWorld = glm::inverse(glm::ortho(-reach, reach, -reach, reach, -2 * reach, 2 * reach) *
                                   glm::lookAt(middle, middle + way, Across(way).first));
  return frame;
}
