// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of a model in every way that an accelerator can have a part in.
#pragma once

#include "Core/Image/Metrics.h"
#include "Testing/Core/FakeAccelerator.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

const glm::i64vec3 AcceleratedDims(60, 50, 40);

inline inr::ModelPointer SomeModel()
{
  auto model = RandomModel(SmallDescription());
  model->volume = VolumeOf(AcceleratedDims);
  return model;
}

/// Everything is seen, whatever its value.
inline inr::TransferFunction Visible()
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    function.table.emplace_back(x, 1 - x, 0.5f, 0.02f + 0.1f * x);
  }
  return function;
}

enum class Way { Still, InTime, Tight, Network, Paths, NetworkPaths };
constexpr Way Ways[] = {Way::Still,   Way::InTime, Way::Tight,
                        Way::Network, Way::Paths,  Way::NetworkPaths};

inline bool IsCached(Way way) { return way != Way::Network && way != Way::NetworkPaths; }

inline inr::RendererOptions OptionsFor(Way way, std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cached = IsCached(way);
  options.cache = Options(inr::CachePrecision::Bits16, 12);
  options.cache.background = way == Way::InTime;
  options.cache.bytes = way == Way::Tight ? 150000 : 8 << 20;
  options.accelerator = std::move(accelerator);
  return options;
}

inline inr::Frame FrameFor(Way way)
{
  inr::Frame frame = Oblique(glm::dvec3(AcceleratedDims), 40);
  frame.levelOfDetailScale = 1; // levels that are filtered, too
  frame.timeLimit = way == Way::InTime ? 1e-3 : 0;
  frame.samplesPerPixel = 2;
  if (way == Way::Paths || way == Way::NetworkPaths) {
    frame.mode = inr::RenderMode::PathTracing;
    frame.paths.ambientLight = glm::vec3(1.0f);
  }
  return frame;
}

/// The complete picture.
inline inr::Image Finish(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image image;
  for (int frames = 0; frames < 20000; ++frames) {
    if (renderer.render(frame, image).complete) {
      return image;
    }
  }
  ADD_FAILURE() << "never complete";
  return image;
}

inline inr::Renderer RendererFor(const inr::ModelPointer& model, Way way,
                                 std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::Renderer renderer(model, OptionsFor(way, std::move(accelerator)));
  renderer.setTransferFunction(Visible());
  return renderer;
}

/// By the CPU alone.
inline inr::Image Truth(const inr::ModelPointer& model, Way way)
{
  inr::Renderer renderer = RendererFor(model, way, nullptr);
  EXPECT_EQ(renderer.accelerator(), "");
  EXPECT_FALSE(renderer.acceleratorFailure());
  inr::Frame frame = FrameFor(way);
  frame.timeLimit = 0;
  return Finish(renderer, frame);
}

/// Standard deviation of red where there is something.
inline double Spread(const inr::Image& image)
{
  double count = 0, sum = 0, squares = 0;
  for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
    if (image.pixels[k + 3] > 0.5f) {
      const double red = static_cast<double>(image.pixels[k]);
      ++count;
      sum += red;
      squares += red * red;
    }
  }
  return std::sqrt(squares / count - sum / count * (sum / count));
}
