// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Parallel.h"
#include "Core/Render/Scene/Frame.h"
#include "Testing/Turbulence/TurbulentChannel.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <map>
#include <string>

namespace inr {

/// What to see of a turbulent channel of `dims` voxels that lies in the world as the VTK source has
/// it: one corner at the origin, `TurbulentChannel::Size` large.
struct ChannelScene
{
  glm::i64vec3 dims{1};
  Frame frame; ///< camera, size, distance of samples, unit of opacity and seed
  /// Straight RGB and opacity at values, linear in between, constant outside; at least one.
  std::map<double, glm::dvec4> colors;
};

/// From JSON: "dims", "size" (pixels), "position", "focal_point" and "view_up" of the camera,
/// "view_angle" (degrees, vertical), "clipping_range", "sample_distance", "unit_distance", "seed",
/// "colors" ([value, r, g, b, opacity] each). Throws Error(InvalidArgument).
ChannelScene ParseChannelScene(const std::string& json);

/// The picture of the field itself that ray marching an INR of it has to come to: the renderer's
/// conventions for rays, for the places of samples of the full resolution along them, and for the
/// medium, but every value straight from the field, and all arithmetic in float64. Premultiplied
/// RGBA. The result does not depend on the number of threads. `samples`, when given, receives how
/// many there were. Throws Error(InvalidArgument) for a frame out of range.
Image DrawChannel(const TurbulentChannel& field, const ChannelScene& scene, const Arena& arena,
                  std::int64_t* samples = nullptr);

} // namespace inr
