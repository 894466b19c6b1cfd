// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/ComposedLight.h"

#include "Core/Error.h"

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace inr {
namespace {

constexpr int Channels = 4;

bool HasSurface(const Surroundings& around, std::size_t pixel)
{
  return (!around.depth.empty() && around.depth[pixel] < 1.0f) ||
         (around.layers && around.layers->depth(0, pixel) < 1.0f);
}

/// Numbers of the pixels before surfaces whose light white behind it would not fit to.
std::vector<int> BrightPixels(const Image& rgba, const Surroundings& around)
{
  std::vector<int> bright;
  for (std::size_t pixel = 0; Channels * pixel < rgba.pixels.size(); ++pixel) {
    const float* color = rgba.pixels.data() + Channels * pixel;
    const float most = std::max({color[0], color[1], color[2]});
    if (most > color[3] && HasSurface(around, pixel)) {
      bright.push_back(static_cast<int>(pixel));
    }
  }
  return bright;
}

/// What the window shows at these pixels of a picture: 8-bit RGBA, premultiplied.
std::vector<unsigned char> WindowColors(vtkRenderer* renderer, const Viewport& viewport,
                                        const Surroundings& picture, const std::vector<int>& pixels)
{
  vtkNew<vtkUnsignedCharArray> window;
  constexpr int back = 0;
  if (renderer->GetRenderWindow()->GetRGBACharPixelData(
          viewport.x, viewport.y, viewport.x + viewport.width - 1, viewport.y + viewport.height - 1,
          back, window) != VTK_OK) {
    throw Error(ErrorCode::CannotRead, "the window's colours cannot be read");
  }
  std::vector<unsigned char> colors;
  colors.reserve(Channels * pixels.size());
  for (const int pixel : pixels) {
    const std::size_t at = Channels * PixelUnder(pixel, picture.width, picture.height, viewport);
    const unsigned char* color = window->GetPointer(static_cast<vtkIdType>(at));
    colors.insert(colors.end(), color, color + Channels);
  }
  return colors;
}

/// The colours of the windows over each other, the first one on top.
glm::vec3 Composed(const std::vector<const unsigned char*>& windows)
{
  glm::vec3 color(0.0f);
  float passes = 1;
  for (const unsigned char* window : windows) {
    if (window[3] > 0) {
      color += passes / 255.0f * glm::vec3(window[0], window[1], window[2]);
      passes *= 1.0f - static_cast<float>(window[3]) / 255.0f;
    }
  }
  return color;
}

} // namespace

void LimitLight(Image& rgba, const Surroundings& around, const PictureGroup& group,
                vtkRenderer* renderer, const Viewport& viewport)
{
  std::vector<int> bright;
  group.together([&] {
    if (group.draws()) {
      bright = BrightPixels(rgba, around);
    }
  });
  group.tellAll(bright);
  if (bright.empty()) {
    return;
  }
  std::vector<unsigned char> own;
  group.together([&] { own = WindowColors(renderer, viewport, around, bright); });
  const std::vector<unsigned char> all = group.gather(own);
  if (!group.draws()) {
    return;
  }
  constexpr float rounding = 1.5f / 255.0f; // half a step of light, opacity and windows each
  std::vector<const unsigned char*> windows(group.order().size());
  for (std::size_t k = 0; k < bright.size(); ++k) {
    std::transform(group.order().begin(), group.order().end(), windows.begin(), [&](int process) {
      return all.data() + static_cast<std::size_t>(process) * own.size() + Channels * k;
    });
    const glm::vec3 behind = Composed(windows);
    float* color = rgba.pixels.data() + Channels * static_cast<std::size_t>(bright[k]);
    for (int channel = 0; channel < 3; ++channel) {
      const float most = 1.0f - (1.0f - color[3]) * behind[channel] - rounding;
      color[channel] = std::clamp(color[channel], 0.0f, std::max(most, 0.0f));
    }
  }
}

} // namespace inr
