// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Renderer.h"

#include <glm/gtc/matrix_transform.hpp>

#include <functional>
#include <utility>

/// An Evaluator of any function of the unit cube: fields with known answers.
class FieldEvaluator : public inr::Evaluator
{
public:
  using Function = std::function<float(const glm::vec3& u)>;

  explicit FieldEvaluator(Function function, const glm::i64vec3& resolution = glm::i64vec3(0))
      : Field(std::move(function)), Resolution(resolution)
  {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    for (std::int64_t k = 0; k < count; ++k) {
      values[k] = this->Field(positions[k]);
    }
  }
  glm::i64vec3 resolution() const override { return this->Resolution; }
  std::string kernel() const override { return "field"; }

private:
  Function Field;
  glm::i64vec3 Resolution;
};

inline inr::VolumeInfo VolumeOf(const glm::i64vec3& dims)
{
  inr::VolumeInfo info;
  info.dims = dims;
  return info;
}

inline inr::Renderer FieldRenderer(const glm::i64vec3& dims, FieldEvaluator::Function function,
                                   const inr::MacroCells& cells = {}, int threads = 2,
                                   bool cached = false)
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cached = cached;
  options.cache.precision = inr::CachePrecision::Float32;
  options.cache.bytes = 64 << 20;
  return {std::make_shared<FieldEvaluator>(std::move(function)), VolumeOf(dims), cells, options};
}

/// The same grey and opacity for every value.
inline inr::TransferFunction UniformMedium(float opacity, const glm::vec3& color = glm::vec3(1))
{
  inr::TransferFunction function;
  function.table = {glm::vec4(color, opacity), glm::vec4(color, opacity)};
  return function;
}

/// White, with opacity rising from 0 at 0 to `top` at 1.
inline inr::TransferFunction OpacityRamp(float top)
{
  inr::TransferFunction function;
  function.table = {glm::vec4(1, 1, 1, 0), glm::vec4(1, 1, 1, top)};
  return function;
}

/// Parallel view along +z of the world box [low, high] in x and y; near and far at z = zNear, zFar.
inline inr::Frame ParallelFrame(int size, const glm::dvec2& low, const glm::dvec2& high,
                                double zNear, double zFar)
{
  inr::Frame frame;
  frame.width = size;
  frame.height = size;
  frame.clipToWorld = glm::dmat4(1.0);
  frame.clipToWorld[0][0] = 0.5 * (high.x - low.x);
  frame.clipToWorld[1][1] = 0.5 * (high.y - low.y);
  frame.clipToWorld[2][2] = 0.5 * (zFar - zNear);
  frame.clipToWorld[3] =
      glm::dvec4(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), 0.5 * (zNear + zFar), 1.0);
  return frame;
}

inline inr::Image Render(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image image;
  renderer.render(frame, image);
  return image;
}
