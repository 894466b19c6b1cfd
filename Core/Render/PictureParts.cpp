// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/PictureParts.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace inr {

PixelBox PixelsOf(const Frame& frame, const glm::i64vec3& dims)
{
  const glm::dmat4 toClip = glm::inverse(frame.worldToIndex * frame.clipToWorld);
  const glm::ivec2 size(frame.width, frame.height);
  glm::dvec2 low(size);
  glm::dvec2 high(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec4 index(-0.5, -0.5, -0.5, 1.0); // a single voxel is a slab
    for (int axis = 0; axis < 3; ++axis) {
      index[axis] += (corner >> axis & 1) != 0 ? static_cast<double>(dims[axis]) : 0.0;
    }
    const glm::dvec4 clip = toClip * index;
    if (!(clip.w > 0)) { // beside or behind the eye
      return {glm::ivec2(0), size};
    }
    const glm::dvec2 at = 0.5 * (glm::dvec2(clip) / clip.w + 1.0) * glm::dvec2(size);
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const glm::dvec2 most(size);
  return {glm::ivec2(glm::clamp(glm::floor(low), glm::dvec2(0.0), most)),
          glm::ivec2(glm::clamp(glm::ceil(high), glm::dvec2(0.0), most))};
}

PixelBox PartOf(const PixelBox& box, int process, int processes)
{
  PixelBox part = box;
  while (processes > 1) {
    const int before = processes / 2; // those in the first half
    const int axis = part.size().x > part.size().y ? 0 : 1;
    const std::int64_t length = part.size()[axis];
    const int cut = part.first[axis] + static_cast<int>(length * before / processes);
    if (process < before) {
      part.end[axis] = cut;
      processes = before;
    } else {
      part.first[axis] = cut;
      process -= before;
      processes -= before;
    }
  }
  return part;
}

void KeepOnly(const PixelBox& own, const glm::ivec2& size, std::vector<float>& depth)
{
  depth.resize(static_cast<std::size_t>(size.x) * size.y, 1.0f);
  for (int row = 0; row < size.y; ++row) {
    const auto begin = depth.begin() + static_cast<std::ptrdiff_t>(size.x) * row;
    const bool isOwn = row >= own.first.y && row < own.end.y;
    std::fill(begin, begin + (isOwn ? own.first.x : size.x), 0.0f);
    std::fill(begin + (isOwn ? own.end.x : size.x), begin + size.x, 0.0f);
  }
}

} // namespace inr
