// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/BrickKernel.h"
#include "Core/Render/RayMarching.h"
#include "Core/Render/ShadingView.h"

namespace inr {
namespace cuda {

/// What a ray-marched frame's rays share, but for the cache: plain data in the device's memory, as
/// are its arrays. It stays where it is as long as rays wait.
struct RenderScene
{
  RayView rays;
  PixelStreams streams;
  MajorantsView majorants;
  MarchSettings settings;
  ColorLookup colors;
  StepLookup steps;
  double levelOfDetailScale; ///< see Frame
  bool lit;
  ShadingView shading; ///< where it is
};

/// What a picture is written to, in the device's memory. Of width * height pixels.
struct PictureView
{
  float* rgba;    ///< premultiplied
  float* depth;   ///< of the window; see Renderer::render
  float* samples; ///< two channels
};

/// Straight RGB, and the opacity of a whole sample of the length that has this number
/// (StepTable.h), at a place in the table: a normalised value or, of logarithmic colours, the
/// coordinate of one.
INR_HOST_DEVICE inline glm::vec4 SampleColor(const StepLookup& steps, int length, float place)
{
  const auto top = static_cast<float>(steps.rows - 3);
  const float position = fmaf(place, steps.scale, steps.bias);
  int entry = 0; // outside the transfer function's range there is a step, not a slope
  float weight = 0.0f;
  if (position > top) {
    entry = steps.rows - 2;
  } else if (position >= 2.0f) {
    entry = static_cast<int>(position);
    weight = position - static_cast<float>(entry);
  }
  const std::int64_t row = static_cast<std::int64_t>(length) * steps.rows + entry;
  const auto* const at = reinterpret_cast<const glm::vec4*>(steps.entries) + row;
  return at[0] + (at[1] - at[0]) * weight;
}

} // namespace cuda
} // namespace inr
