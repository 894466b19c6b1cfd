// SPDX-License-Identifier: BSD-3-Clause
//
// A volume that several renderers draw, and the picture of one that is alone.
#pragma once

#include "Testing/Core/Render/VoxelScene.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

inline const glm::i64vec3 SharedDims(90, 70, 80);

/// Waves of some length, and how many values of them were asked for.
class CountedWaves
{
public:
  explicit CountedWaves(float length) : Asked(std::make_shared<std::atomic<std::int64_t>>(0))
  {
    this->Values = std::make_shared<FieldEvaluator>([asked = this->Asked, length](glm::vec3 u) {
      ++*asked;
      return Waves(u * length);
    });
  }
  std::int64_t asked() const { return *this->Asked; }

  inr::Renderer renderer(const inr::CacheOptions& cache, int threads = 1) const
  {
    inr::RendererOptions options;
    options.threads = threads;
    options.cache = cache;
    inr::Renderer renderer(this->Values, VolumeOf(SharedDims), {}, options);
    renderer.setTransferFunction(Colours());
    return renderer;
  }

private:
  std::shared_ptr<std::atomic<std::int64_t>> Asked;
  std::shared_ptr<const inr::Evaluator> Values;
};

inline inr::CacheOptions SharedCache(std::int64_t bytes, bool background = true)
{
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 16);
  options.bytes = bytes;
  options.background = background;
  return options;
}

/// The volume from one side or, a little larger, from the other.
inline inr::Frame SharedView(bool other)
{
  inr::Frame frame = Oblique(glm::dvec3(SharedDims), 24);
  if (other) {
    Turn(frame, glm::dvec3(SharedDims), 2.2);
    frame.clipToWorld[0] *= 0.9;
  }
  return frame;
}

constexpr std::int64_t EnoughToShare = 64 << 20;
constexpr std::int64_t HalfOfASharedView = 500000; ///< some fifty bricks

inline std::vector<float> DrawnAlone(const CountedWaves& field, inr::Frame frame)
{
  frame.timeLimit = 0;
  inr::Renderer renderer = field.renderer(SharedCache(EnoughToShare, false));
  return Render(renderer, frame).pixels;
}
