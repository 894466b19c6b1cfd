// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn in tests of pictures by kernels, and how.
#pragma once

#include "CUDA/CudaAccelerator.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/CUDA/EmulatedAccelerator.h"
#include "Testing/CUDA/Places.h"
#include "Testing/CUDA/TrainedModel.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

/// Whose macro-cells, as another program's file may, say less than there is.
inline inr::ModelPointer WithNarrowRanges()
{
  auto model = std::make_shared<inr::Model>(*TrainedModel());
  for (inr::ValueRange& range : model->macroCells.ranges) {
    range = {0.3f, 0.6f};
  }
  model->macroCells.provenance = inr::MacroCellProvenance::File;
  return model;
}

inline inr::RendererOptions OptionsWith(std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cache = Options(inr::CachePrecision::Bits16, 12);
  options.accelerator = std::move(accelerator);
  return options;
}

inline std::shared_ptr<const inr::Accelerator> Device(HostLaunch launch = {})
{
  return std::make_shared<EmulatedAccelerator>(inr::cuda::Precision::Float32, Duty::InfersAndDraws,
                                               launch);
}

inline inr::TransferFunction ColoursOf(const inr::VolumeInfo& volume)
{
  inr::TransferFunction colours = Colours();
  colours.low = volume.low;
  colours.high = volume.high;
  return colours;
}

inline inr::Renderer RendererOf(const inr::RendererOptions& options)
{
  inr::Renderer renderer(TrainedModel(), options);
  renderer.setTransferFunction(ColoursOf(TrainedModel()->volume));
  return renderer;
}

inline inr::Frame PlainFrame()
{
  inr::Frame frame = Oblique(glm::dvec3(TrainedModel()->volume.dims));
  frame.levelOfDetailScale = 1;
  return frame;
}

constexpr inr::RenderMode Modes[] = {inr::RenderMode::RayMarching, inr::RenderMode::PathTracing};

/// Of few pixels, for what is drawn many times or by slow devices.
inline inr::Frame SmallFrame(inr::RenderMode mode)
{
  inr::Frame frame = PlainFrame();
  frame.mode = mode;
  frame.width = 16;
  frame.height = 12;
  frame.samplesPerPixel = 1;
  return frame;
}

/// The same from level 0.
inline inr::Frame FullResolution(inr::RenderMode mode)
{
  inr::Frame frame = SmallFrame(mode);
  frame.levelOfDetailScale = 0;
  return frame;
}

/// A picture and all that comes with it.
struct Drawn
{
  inr::Image rgba;
  inr::Image depth;
  inr::Image samples;
  inr::FrameStatistics statistics;
};

inline Drawn Draw(const inr::Frame& frame, const inr::RendererOptions& options)
{
  inr::Renderer renderer = RendererOf(options);
  Drawn drawn;
  drawn.statistics = renderer.render(frame, drawn.rgba, &drawn.depth, {}, &drawn.samples);
  EXPECT_FALSE(renderer.acceleratorFailure()) << renderer.acceleratorFailure()->reason;
  return drawn;
}

/// A kind of frame.
struct Case
{
  const char* name;
  std::function<void(inr::Frame&)> change;
};

inline void PrintTo(const Case& which, std::ostream* stream) { *stream << which.name; }

/// Rows of rising depth, in front of, inside and behind the volume.
inline const std::vector<float>& SomeDepth()
{
  static const std::vector<float> depth = [] {
    const inr::Frame frame = PlainFrame();
    std::vector<float> values(static_cast<std::size_t>(frame.width) * frame.height, 1.0f);
    for (std::size_t k = 0; k < values.size() / 2; ++k) {
      values[k] = 0.5f + 0.5f * static_cast<float>(k) / static_cast<float>(values.size() / 2);
    }
    return values;
  }();
  return depth;
}

inline void ShowSurfaces(inr::Frame& frame)
{
  const inr::VolumeInfo& volume = TrainedModel()->volume;
  frame.blending.mode = inr::BlendMode::Isosurface;
  for (const double value : {0.3, 0.45, 0.6}) {
    frame.blending.isosurfaces.push_back(volume.low + value * (volume.high - volume.low));
  }
}

/// Three surfaces behind one another: from in front of the volume, row by row, to behind it, and in
/// the last rows none; clear at one pixel, half clear or opaque at the next ones.
inline void AddLayers(inr::Frame& frame)
{
  const int pixels = frame.width * frame.height;
  auto made = std::make_shared<inr::TranslucentLayers>();
  made->layers.resize(3);
  for (int pixel = 0; pixel < pixels; ++pixel) {
    const float rest = 0.5f - 0.6f * static_cast<float>(pixel) / static_cast<float>(pixels);
    for (int k = 0; k < 3; ++k) {
      const float behind = std::max(rest, 0.0f) / static_cast<float>(1 << k);
      const float alpha = static_cast<float>((pixel + k) % 5) / 4.0f;
      inr::TranslucentLayers::Layer& layer = made->layers[static_cast<std::size_t>(k)];
      layer.depth.push_back(1.0f - behind);
      layer.colors.push_back(alpha * glm::vec4(0.2f, 0.3f * static_cast<float>(k), 0.6f, 1.0f));
    }
  }
  frame.layers = std::move(made);
}

inline inr::Light LightOf(inr::LightKind kind)
{
  const glm::dvec3 dims(TrainedModel()->volume.dims);
  inr::Light light;
  light.kind = kind;
  light.position = dims * glm::dvec3(1.5, 1.4, 1.3);
  light.direction =
      kind == inr::LightKind::Directional ? glm::dvec3(1, -2, -1) : 0.5 * dims - light.position;
  light.color = glm::vec3(1.0f, 0.8f, 0.6f);
  return light;
}

inline void LightUp(inr::Frame& frame)
{
  frame.lights = {LightOf(inr::LightKind::Point), LightOf(inr::LightKind::Directional),
                  LightOf(inr::LightKind::Spot)};
}

/// Lights samples with these.
inline void Shade(inr::Frame& frame)
{
  frame.shading = inr::Material();
  LightUp(frame);
}

/// Through the middle of the volume.
inline glm::dvec4 PlaneAcross(const glm::dvec3& normal)
{
  return {normal, -glm::dot(normal, 0.5 * glm::dvec3(TrainedModel()->volume.dims))};
}

inline std::function<void(inr::Frame&)> Projected(inr::BlendMode mode)
{
  return [mode](inr::Frame& frame) { frame.blending.mode = mode; };
}

inline void Crop(inr::Frame& frame)
{
  const glm::dvec3 dims(TrainedModel()->volume.dims);
  frame.cropping = inr::Cropping{0.3 * dims, 0.62 * dims, 0x5555555};
}

/// Of two pictures of the same shape, by channel.
inline double LargestDifference(const inr::Image& a, const inr::Image& b)
{
  double largest = 0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    largest = std::max(largest, std::abs(static_cast<double>(a.pixels[k]) - b.pixels[k]));
  }
  return largest;
}

/// Which part of the values is off by more than `most`.
inline double Others(const inr::Image& a, const inr::Image& b, float most)
{
  std::size_t others = 0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    others += std::abs(a.pixels[k] - b.pixels[k]) <= most ? 0 : 1;
  }
  return static_cast<double>(others) / static_cast<double>(a.pixels.size());
}

/// What draws in a place.
inline std::shared_ptr<const inr::Accelerator> DeviceIn(Place place)
{
  return place == Place::Gpu ? inr::cuda::MakeAccelerator(inr::cuda::ChooseDevice()) : Device();
}

/// Tests of cases in every place.
class CaseInAPlace : public testing::TestWithParam<std::tuple<Place, Case>>
{
public:
  static std::string nameOf(const testing::TestParamInfo<std::tuple<Place, Case>>& info)
  {
    return std::string(TextOf(std::get<0>(info.param))) + std::get<1>(info.param).name;
  }

protected:
  void SetUp() override { SkipUnlessThere(std::get<0>(GetParam())); }
};
