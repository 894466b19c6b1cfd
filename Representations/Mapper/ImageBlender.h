// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "FrameBuilder.h"

#include <memory>

class vtkOpenGLRenderWindow;
class vtkRenderer;
class vtkWindow;

namespace inr {

/// Draws float images over what a render window holds.
class ImageBlender
{
public:
  ImageBlender();
  ~ImageBlender();
  ImageBlender(const ImageBlender&) = delete;
  ImageBlender& operator=(const ImageBlender&) = delete;

  /// Blends premultiplied `rgba` over the viewport of `renderer`, window alpha included; an image
  /// smaller than the viewport is stretched linearly. False when the window is not an OpenGL one or
  /// the texture or shader cannot be made.
  bool blend(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba);

  /// Puts `color` wherever `rgba` is not transparent, as a selection buffer wants it.
  bool mark(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba,
            const float color[3]);

  /// Frees texture and shaders; required before `window` goes away.
  void release(vtkWindow* window);

private:
  bool draw(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba, const float* color);
  bool upload(vtkOpenGLRenderWindow* window, const Viewport& viewport, const Image& rgba);

  struct Resources;
  std::unique_ptr<Resources> Self;
};

} // namespace inr
