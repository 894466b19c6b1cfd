// SPDX-License-Identifier: BSD-3-Clause
//
// A smooth field, its voxels, and the cached and uncached renderers of both.
#pragma once

#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

inline float Waves(const glm::vec3& u)
{
  return 0.5f + 0.5f * std::sin(9.0f * u.x + 4.0f * u.y * u.y) * std::cos(7.0f * u.z - 3.0f * u.x);
}

/// The voxels of a field with trilinear interpolation between them, in double.
class Voxels
{
public:
  Voxels(const glm::i64vec3& dims, const FieldEvaluator::Function& field) : Dims(dims)
  {
    for (std::int64_t z = 0; z < dims.z; ++z) {
      for (std::int64_t y = 0; y < dims.y; ++y) {
        for (std::int64_t x = 0; x < dims.x; ++x) {
          this->Values.push_back(field(glm::vec3((glm::dvec3(x, y, z) + 0.5) / glm::dvec3(dims))));
        }
      }
    }
  }

  float at(const glm::vec3& u) const
  {
    const glm::dvec3 last(this->Dims - std::int64_t{1});
    const glm::dvec3 place =
        glm::clamp(glm::dvec3(u) * glm::dvec3(this->Dims) - 0.5, glm::dvec3(0.0), last);
    const glm::dvec3 cell = glm::floor(place);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 near = 1.0 - glm::abs(place - cell - step);
      const glm::i64vec3 v(glm::min(cell + step, last));
      sum +=
          near.x * near.y * near.z *
          this->Values[static_cast<std::size_t>(v.x + this->Dims.x * (v.y + this->Dims.y * v.z))];
    }
    return static_cast<float>(sum);
  }

private:
  glm::i64vec3 Dims;
  std::vector<float> Values;
};

inline inr::TransferFunction Colours()
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    function.table.emplace_back(x, 1 - x, 0.5f, x > 0.5f ? 0.4f * (x - 0.5f) : 0.0f);
  }
  return function;
}

inline inr::Renderer CachedRenderer(const glm::i64vec3& dims, const FieldEvaluator::Function& field,
                                    const inr::CacheOptions& cache, int threads = 2)
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cache = cache;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(dims), {}, options);
  renderer.setTransferFunction(Colours());
  return renderer;
}

inline inr::Frame Oblique(const glm::dvec3& dims, int size = 48)
{
  inr::Frame frame;
  frame.width = size;
  frame.height = size - 11;
  const glm::dmat4 view =
      glm::lookAt(dims * glm::dvec3(1.9, 1.4, 2.3), 0.5 * dims, glm::dvec3(0.1, 1, 0));
  const double reach = glm::length(dims);
  frame.clipToWorld =
      glm::inverse(glm::perspective(glm::radians(40.0), 48.0 / 37, 0.2 * reach, 5 * reach) * view);
  frame.levelOfDetailScale = 0;
  frame.sampleDistance = 0.7;
  return frame;
}

/// Turns what a frame shows about the vertical axis through the volume's middle; radians.
inline void Turn(inr::Frame& frame, const glm::dvec3& dims, double angle)
{
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 1, 0));
  const glm::dmat4 center = glm::translate(glm::dmat4(1.0), 0.5 * dims);
  frame.clipToWorld = center * turn * glm::inverse(center) * frame.clipToWorld;
}

/// Adds a translucent surface, behind those there are, at a window-space depth in all pixels.
inline void AddLayer(inr::Frame& frame, float depth, const glm::vec4& color)
{
  const auto pixels = static_cast<std::size_t>(frame.width) * frame.height;
  auto layers = frame.layers ? std::make_shared<inr::TranslucentLayers>(*frame.layers)
                             : std::make_shared<inr::TranslucentLayers>();
  layers->layers.push_back(
      {std::vector<float>(pixels, depth), std::vector<glm::vec4>(pixels, color)});
  frame.layers = layers;
}

/// One half way through what Oblique() shows.
inline void AddLayerHalfWay(inr::Frame& frame)
{
  AddLayer(frame, 0.905f, {0.1f, 0.2f, 0.3f, 0.5f});
}

inline inr::CacheOptions Options(inr::CachePrecision precision, int brickSize)
{
  inr::CacheOptions options;
  options.precision = precision;
  options.brickSize = brickSize;
  options.bytes = 64 << 20;
  return options;
}

/// Calls compare(through the cache, over the dense voxels) with pictures of volumes of odd shapes
/// in bricks of several sizes; frameOf(dims) is what to look at.
template <typename FrameOf, typename Compare>
void CompareWithDense(const FrameOf& frameOf, const Compare& compare)
{
  for (const glm::i64vec3& dims : {glm::i64vec3(33, 46, 21), glm::i64vec3(50, 3, 40),
                                   glm::i64vec3(40, 40, 1), glm::i64vec3(17, 64, 2)}) {
    const Voxels voxels(dims, Waves);
    inr::Renderer dense = FieldRenderer(
        dims, [&](const glm::vec3& u) { return voxels.at(u); }, {}, 2);
    dense.setTransferFunction(Colours());
    const inr::Frame frame = frameOf(glm::dvec3(dims));
    const inr::Image truth = Render(dense, frame);
    for (const int brickSize : {4, 9, 40}) {
      SCOPED_TRACE(brickSize);
      inr::Renderer cached =
          CachedRenderer(dims, Waves, Options(inr::CachePrecision::Float32, brickSize));
      compare(Render(cached, frame), truth);
    }
  }
}
