// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Model/Model.h"
#include "Core/Render/Scene/SparseTable.h"
#include "Core/Render/Scene/TransferFunction.h"

#include <glm/common.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace inr {

/// A transfer function over a network's normalised output; device-ready plain data.
struct ColorLookup
{
  const glm::vec4* entries = nullptr;
  int count = 0;
  float scale = 0; ///< table coordinate = scale * x + bias, x = y or log(valueLow + valueScale * y)
  float bias = 0;
  bool logarithmic = false;
  float valueLow = 0; ///< over the table's lowest value, or the volume's largest
  float valueScale = 0;
  glm::vec4 below{0};
  glm::vec4 above{0};

  INR_HOST_DEVICE float coordinate(float y) const
  {
    if (!this->logarithmic) {
      return this->scale * y + this->bias;
    }
    const float value = this->valueLow + this->valueScale * y;
    return value > 0.0f ? this->scale * std::log(value) + this->bias : -1.0f;
  }

  /// Straight RGB and opacity per unit distance.
  INR_HOST_DEVICE glm::vec4 at(float y) const
  {
    const float position = this->coordinate(y);
    if (position < 0.0f) {
      return this->below;
    }
    const auto last = static_cast<float>(this->count - 1);
    if (position > last) {
      return this->above;
    }
    const int cell =
        static_cast<int>(position) < this->count - 2 ? static_cast<int>(position) : this->count - 2;
    const float weight = position - static_cast<float>(cell);
    return glm::mix(this->entries[cell], this->entries[cell + 1], weight);
  }
};

/// A TransferFunction composed with a volume's value range, in double, once.
class ColorTable
{
public:
  /// Throws Error(InvalidArgument); see Renderer::setTransferFunction.
  ColorTable(const TransferFunction& transferFunction, const VolumeInfo& volume);

  const ColorLookup& lookup() const { return this->Lookup; }

  /// Whether there are values that are transparent.
  bool hidesAny() const;
  /// Largest extinction, -ln(1 - opacity), over the normalised values [low, high]; 0 for an empty
  /// range.
  float maximumExtinction(const ValueRange& range) const;
  /// Those of `count` ranges.
  void maximumExtinctions(const ValueRange* ranges, std::int64_t count, float* extinctions) const;

private:
  std::vector<glm::vec4> Entries;
  SparseTable<Maximum> Extinctions; ///< of the entries
  float Below;                      ///< extinction outside the transfer function's range
  float Above;
  ColorLookup Lookup;
};

} // namespace inr
