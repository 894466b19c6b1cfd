// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

/// A field that keeps a record of all that it is asked: points, and bricks layer by layer.
class RecordingField : public FieldEvaluator
{
public:
  /// What a layer of a brick covers along x and y, and of which level it is.
  struct Box
  {
    glm::dvec3 low; ///< voxels of level 0, of the first and the last point
    glm::dvec3 high;
    int level;
  };

  RecordingField(const glm::i64vec3& dims, Function field)
      : FieldEvaluator(std::move(field)), Dims(dims)
  {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    this->All += count;
    FieldEvaluator::evaluate(positions, count, values);
  }

  void evaluateGrid(const std::vector<float> (&axes)[3], float* values) const override
  {
    const auto points = static_cast<std::int64_t>(axes[0].size() * axes[1].size() * axes[2].size());
    this->InGrids += points;
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      Box box{};
      for (int axis = 0; axis < 3; ++axis) {
        const auto dims = static_cast<double>(this->Dims[axis]);
        box.low[axis] = static_cast<double>(axes[axis].front()) * dims - 0.5;
        box.high[axis] = static_cast<double>(axes[axis].back()) * dims - 0.5;
      }
      // Coarse layers have two points a voxel along z, half as far apart as voxels are.
      const double apart = box.high.z - box.low.z;
      box.level = axes[2].size() == 1 ? 0 : static_cast<int>(std::lround(std::log2(apart))) + 1;
      this->Layers.push_back(box);
    }
    FieldEvaluator::evaluateGrid(axes, values);
  }

  std::int64_t inGrids() const { return this->InGrids; }               ///< points of bricks
  std::int64_t scattered() const { return this->All - this->InGrids; } ///< points one by one
  std::vector<Box> layers(int level) const
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    std::vector<Box> found;
    std::copy_if(this->Layers.begin(), this->Layers.end(), std::back_inserter(found),
                 [level](const Box& box) { return box.level == level; });
    return found;
  }

private:
  glm::i64vec3 Dims;
  mutable std::atomic<std::int64_t> All{0};
  mutable std::atomic<std::int64_t> InGrids{0};
  mutable std::mutex Mutex;
  mutable std::vector<Box> Layers;
};

/// A volume whose field is recorded, and a renderer of it.
struct RecordedScene
{
  explicit RecordedScene(const inr::RendererOptions& options,
                         const FieldEvaluator::Function& function = Waves,
                         const glm::i64vec3& size = glm::i64vec3(47, 41, 44),
                         const inr::MacroCells& cells = {})
      : dims(size), field(std::make_shared<RecordingField>(size, function)),
        renderer(field, VolumeOf(size), cells, options)
  {
    this->renderer.setTransferFunction(Colours());
  }

  inr::WorkDone render(const inr::Frame& frame)
  {
    inr::Image image;
    this->statistics = this->renderer.render(frame, image);
    return this->statistics.work;
  }

  glm::i64vec3 dims;
  std::shared_ptr<RecordingField> field;
  inr::Renderer renderer;
  inr::FrameStatistics statistics; ///< of the last frame
};

/// Through a cache in small bricks, two threads, no loader.
inline inr::RendererOptions SmallBricks(bool cached = true)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cached = cached;
  options.cache = Options(inr::CachePrecision::Bits16, 9);
  options.cache.background = false;
  return options;
}

inline inr::Light Headlight()
{
  inr::Light light;
  light.direction = glm::dvec3(-1.9, -1.4, -2.3);
  return light;
}

inline inr::Frame ShadedView(const glm::i64vec3& dims)
{
  inr::Frame frame = Oblique(glm::dvec3(dims));
  frame.shading = inr::Material{};
  frame.lights = {Headlight()};
  return frame;
}

inline inr::Frame PathView(const glm::i64vec3& dims, int samples = 2)
{
  inr::Frame frame = Oblique(glm::dvec3(dims));
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = samples;
  frame.unitDistance = 3;
  frame.lights = {Headlight()};
  return frame;
}
