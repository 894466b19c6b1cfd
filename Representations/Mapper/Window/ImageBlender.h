// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Representations/Mapper/Scene/Viewport.h"

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

  /// Puts the colours of `identities` wherever it is not transparent; one smaller than the viewport
  /// is enlarged pixel by pixel.
  bool mark(vtkRenderer* renderer, const Viewport& viewport, const Image& identities);

  /// Frees texture and shaders; required before `window` goes away.
  void release(vtkWindow* window);

private:
  enum class Mode { Blend, Mark };
  bool draw(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba, Mode mode);
  bool upload(vtkOpenGLRenderWindow* window, const Image& rgba, bool smooth);

  struct Resources;
  std::unique_ptr<Resources> Self;
};

} // namespace inr
