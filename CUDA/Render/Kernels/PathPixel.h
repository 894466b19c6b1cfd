// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/Kernels/RenderScene.h"
#include "Core/Render/Paths/PathTracing.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// What a path that has ended shows: of the depth, that of its first collision, 0 where there was
/// none.
INR_HOST_DEVICE inline void WritePath(const PathScene& scene, const PathState& path,
                                      const PictureView& picture, std::int64_t pixel)
{
  const bool collided = path.collided;
  reinterpret_cast<glm::vec4*>(picture.rgba)[pixel] = ShownColor(scene, path, pixel);
  picture.depth[pixel] =
      collided ? static_cast<float>(scene.rays.windowDepth(path.firstCollision)) : 0.0f;
}

} // namespace cuda
} // namespace inr
