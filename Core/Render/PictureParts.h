// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>

#include <vector>

namespace inr {

/// Pixels of a picture from `first` to before `end`, both from the bottom left.
struct PixelBox
{
  glm::ivec2 first{0};
  glm::ivec2 end{0};

  glm::ivec2 size() const { return this->end - this->first; }
};

/// Those of a frame's pixels that may show a volume of `dims` voxels.
PixelBox PixelsOf(const Frame& frame, const glm::i64vec3& dims);

/// The part of `box` that is drawn by one of several processes, `process` from 0 to before
/// `processes`. The parts make up the box, and no two share a pixel. They are halved across their
/// longer side again and again, as compact as they get: what a brick shows is then in few of them,
/// and seldom are all the pixels that take long in one.
PixelBox PartOf(const PixelBox& box, int process, int processes);

/// Puts something at the eye wherever rays are others' to cast: all pixels of a picture of `size`
/// but those of `own`. An empty `depth`, window depths as Frame has them, is one of nothing.
void KeepOnly(const PixelBox& own, const glm::ivec2& size, std::vector<float>& depth);

} // namespace inr
