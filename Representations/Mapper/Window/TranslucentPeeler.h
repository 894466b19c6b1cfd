// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/TranslucentLayers.h"
#include "Representations/Mapper/Scene/Viewport.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

class vtkProp;
class vtkRenderer;
class vtkWindow;

namespace inr {

/// The visible props of a renderer that have translucent geometry.
std::vector<vtkProp*> TranslucentProps(vtkRenderer* renderer);

/// How many layers a picture of so many pixels may have: 64, fewer where they took more than 1 GiB,
/// but no fewer than 4.
inline int MostLayers(std::int64_t pixels)
{
  constexpr std::int64_t memory = std::int64_t{1} << 30;
  constexpr std::int64_t bytes = sizeof(float) + sizeof(glm::vec4); // of a pixel's surface
  return static_cast<int>(std::clamp<std::int64_t>(memory / (bytes * pixels), 4, 64));
}

/// Draws translucent props layer by layer, from front to back, into buffers of its own and reads
/// them back. What the window holds stays as it is.
class TranslucentPeeler
{
public:
  TranslucentPeeler();
  ~TranslucentPeeler();
  TranslucentPeeler(const TranslucentPeeler&) = delete;
  TranslucentPeeler& operator=(const TranslucentPeeler&) = delete;

  /// As many layers as it takes to have all of `props`, at most MostLayers() of them; those further
  /// behind then count as if they were behind everything. Null when there is nothing in front of
  /// `opaqueDepth` (of the viewport, or empty when there is none) or no OpenGL to draw with.
  std::shared_ptr<const TranslucentLayers> peel(vtkRenderer* renderer, const Viewport& viewport,
                                                const std::vector<vtkProp*>& props,
                                                const std::vector<float>& opaqueDepth);

  /// Frees what is in graphics memory; required before `window` goes away.
  void release(vtkWindow* window);

private:
  struct Resources;
  std::unique_ptr<Resources> Self;
};

/// The layers at the centres of the pixels of a smaller picture over the same viewport.
std::shared_ptr<const TranslucentLayers>
ReduceLayers(const TranslucentLayers& layers, const Viewport& viewport, int width, int height);

} // namespace inr
