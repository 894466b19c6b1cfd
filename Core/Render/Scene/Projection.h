// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Model/MacroCells.h"
#include "Core/Render/Scene/Blending.h"
#include "Core/Render/Scene/ColorTable.h"
#include "Core/Render/Scene/Isosurfaces.h"

#include <glm/common.hpp>
#include <glm/vec4.hpp>

namespace inr {

/// What a ray has gathered of the values that it projects. Sums are in double and in the order of
/// the samples, so that it does not matter where a ray had to wait.
struct Projection
{
  double sum = 0;    ///< of what is averaged or added up
  double weight = 0; ///< length of what is averaged
  double at = -1;    ///< t of the extreme
  float extreme = 0; ///< the largest or the smallest value so far
  bool any = false;  ///< whether there is one
};

/// How a frame's rays look at values; see BlendMode. Plain data.
struct Projector
{
  BlendMode mode = BlendMode::Composite;
  SurfaceLookup surfaces;          ///< to find
  ValueRange averaged{0.0f, 1.0f}; ///< normalised values that count for the average
  ValueRange bounds{0.0f, 1.0f};   ///< of all values that a ray can meet

  INR_HOST_DEVICE bool projects() const
  {
    return this->mode != BlendMode::Composite && !this->findsSurfaces();
  }
  INR_HOST_DEVICE bool findsSurfaces() const { return this->mode == BlendMode::Isosurface; }
  INR_HOST_DEVICE bool isExtreme() const
  {
    return this->mode == BlendMode::MaximumIntensity || this->mode == BlendMode::MinimumIntensity;
  }

  /// Whether values in `range` would change nothing any more.
  INR_HOST_DEVICE bool canSkip(const Projection& projection, const ValueRange& range) const
  {
    const bool above = this->mode == BlendMode::MaximumIntensity;
    return projection.any &&
           (above ? range.high <= projection.extreme
                  : this->mode == BlendMode::MinimumIntensity && range.low >= projection.extreme);
  }

  /// Whether nothing that may follow would change the picture.
  INR_HOST_DEVICE bool isFinal(const Projection& projection) const
  {
    return this->mode == BlendMode::Additive ? projection.sum >= 1.0
                                             : this->canSkip(projection, this->bounds);
  }

  /// A sample at `t` that stands for `length` opacity unit distances.
  INR_HOST_DEVICE void add(const ColorLookup& colors, float value, double length, double t,
                           Projection& projection) const
  {
    if (this->isExtreme()) {
      if (!this->canSkip(projection, {value, value})) {
        projection.extreme = value;
        projection.at = t;
        projection.any = true;
      }
    } else if (this->mode == BlendMode::Additive ||
               (value >= this->averaged.low && value <= this->averaged.high)) {
      projection.sum += static_cast<double>(colors.at(value).w) * value * length;
      projection.weight += length;
    }
  }

  /// Premultiplied, of a ray that met the volume.
  INR_HOST_DEVICE glm::vec4 color(const ColorLookup& colors, const Projection& projection) const
  {
    if (this->isExtreme()) {
      const glm::vec4 entry = projection.any ? colors.at(projection.extreme) : glm::vec4(0.0f);
      return {entry.x * entry.w, entry.y * entry.w, entry.z * entry.w, entry.w};
    }
    const bool averages = this->mode == BlendMode::AverageIntensity;
    if (averages && !(projection.weight > 0)) {
      return glm::vec4(0.0f);
    }
    const double value = averages ? projection.sum / projection.weight : projection.sum;
    const auto grey = static_cast<float>(glm::clamp(value, 0.0, 1.0));
    return {grey, grey, grey, 1.0f};
  }
};

} // namespace inr
