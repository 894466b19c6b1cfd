// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/Kernels/ReadOnly.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Marching/RayMarching.h"
#include "Core/Render/Marching/ShadingView.h"
#include "Core/Render/Marching/StepTable.h"

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

/// Two entries of a table of steps, and how much the second one counts.
struct StepColor
{
  glm::vec4 low;
  glm::vec4 high;
  float weight;

  /// Straight RGB, and the opacity of a whole sample of `length` opacity unit distances.
  INR_HOST_DEVICE glm::vec4 color(float length) const
  {
    glm::vec4 color;
    for (int channel = 0; channel < 4; ++channel) {
      color[channel] =
          fmaf(this->high[channel] - this->low[channel], this->weight, this->low[channel]);
    }
    if (color.w > 1.0f) {
      color.w = SteepOpacity(this->low.w, this->high.w, this->weight, length);
    }
    return color;
  }
};

/// Of samples of the length that has this number, at a place in the table: a
/// normalised value or, of logarithmic colours, the coordinate of one.
INR_HOST_DEVICE inline StepColor FindColor(const StepLookup& steps, int length, float place)
{
  const auto top = static_cast<float>(steps.rows - 3);
  const float position = fmaf(place, steps.scale, steps.bias);
  // Outside the transfer function's range there is a step, not a slope.
  const bool isAbove = position > top;
  const bool isIn = position >= 2.0f && !isAbove;
  const int entry = isIn ? static_cast<int>(position) : (isAbove ? steps.rows - 2 : 0);
  const float weight = isIn ? position - static_cast<float>(entry) : 0.0f;
  const float* const at = steps.entries + 4 * (std::int64_t{length} * steps.rows + entry);
  return {ReadOnlyFour(at), ReadOnlyFour(at + 4), weight};
}

} // namespace cuda
} // namespace inr
