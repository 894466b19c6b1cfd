// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/ColorSensitivity.h"

#include "Core/Render/Scene/Opacity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace inr {

namespace {

struct Interval
{
  double low;
  double high;
};

Interval Hull(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

/// Of all products of values of two linear or monotone functions.
Interval Product(const Interval& a, const Interval& b)
{
  const auto [low, high] =
      std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}

/// A step at a table entry.
struct Step
{
  double opacity;
  double slope; ///< of it, per change of the entry's opacity; may be infinite
};

Step StepAt(double entry, double length)
{
  if (entry < 1.0) {
    const double depth = ExtinctionOf(entry); // of a unit distance
    return {OpacityOf(depth * length), length * std::exp(-depth * (length - 1.0))};
  }
  return {1.0, length < 1.0 ? Infinite : length == 1.0 ? 1.0 : 0.0};
}

/// Between two entries, the slopes per entry of a channel of straight colour, in front of light
/// `behind`: those of c A - B A = c' A + (c - B) A'. Both entries, c and A are monotone in between.
Interval SlopesOf(const glm::dvec2& color, const glm::dvec2& opacity, double behind, double length)
{
  const Step first = StepAt(opacity[0], length);
  const Step second = StepAt(opacity[1], length);
  const double rise = opacity[1] - opacity[0];
  const Interval opacities = Hull(first.opacity, second.opacity);
  const double change = color[1] - color[0];
  const Interval own = Product({change, change}, opacities);
  if (rise == 0.0) {
    return own;
  }
  if (!std::isfinite(first.slope) || !std::isfinite(second.slope)) {
    return {-Infinite, Infinite};
  }
  const Interval steep = Product(Hull(color[0] - behind, color[1] - behind),
                                 Hull(rise * first.slope, rise * second.slope));
  return {own.low + steep.low, own.high + steep.high};
}

} // namespace

ColorSensitivity::ColorSensitivity(const ColorLookup& colors, double stepLength) : Colors(colors)
{
  const glm::vec4* entries = colors.entries;
  const auto last = static_cast<std::size_t>(colors.count - 1);
  const auto jumps = [](const glm::vec4& a, const glm::vec4& b) {
    return a != b && (a.w > 0.0f || b.w > 0.0f);
  };
  this->JumpsBelow = jumps(colors.below, entries[0]);
  this->JumpsAbove = jumps(colors.above, entries[last]);
  double brightest = 1.0;
  const auto lookAt = [&](const glm::vec4& entry) {
    brightest = std::max({brightest, double{entry.x}, double{entry.y}, double{entry.z}});
  };
  std::for_each(entries, entries + colors.count, lookAt);
  lookAt(colors.below);
  lookAt(colors.above);
  // Of each colour in front of black and in front of the brightest light, and of opacity.
  std::vector<float> smallest[7];
  std::vector<float> largest[7];
  std::vector<float> depths;
  const auto depthOf = [&](const glm::vec4& entry) {
    return static_cast<float>(ExtinctionOf(double{entry.w}) * stepLength);
  };
  for (std::size_t k = 0; k < last; ++k) {
    const glm::dvec2 opacity(entries[k].w, entries[k + 1].w);
    for (int row = 0; row < 7; ++row) {
      const int channel = row % 4;
      const glm::dvec2 color = channel == 3
                                   ? glm::dvec2(1.0) // premultiplied, opacity itself
                                   : glm::dvec2(entries[k][channel], entries[k + 1][channel]);
      const Interval slopes = SlopesOf(color, opacity, row < 4 ? 0.0 : brightest, stepLength);
      smallest[row].push_back(static_cast<float>(slopes.low));
      largest[row].push_back(static_cast<float>(slopes.high));
    }
    depths.push_back(std::min(depthOf(entries[k]), depthOf(entries[k + 1])));
  }
  this->Depths = SparseTable<Minimum>(std::move(depths));
  this->DepthBelow = depthOf(colors.below);
  this->DepthAbove = depthOf(colors.above);
  for (int row = 0; row < 7; ++row) {
    this->Channels.push_back({SparseTable<Minimum>(std::move(smallest[row])),
                              SparseTable<Maximum>(std::move(largest[row]))});
  }
}

ColorSensitivity::Slopes ColorSensitivity::slopes(const ValueRange& range) const
{
  constexpr float infinite = std::numeric_limits<float>::infinity();
  if (range.empty()) {
    return {};
  }
  const float begin = this->Colors.coordinate(range.low);
  const float end = this->Colors.coordinate(range.high);
  const auto top = static_cast<float>(this->Colors.count - 1);
  if (end < 0.0f || begin > top) {
    return {0, 0, end < 0.0f ? this->DepthBelow : this->DepthAbove};
  }
  const auto interval = [&](float coordinate) {
    return static_cast<int>(std::clamp(coordinate, 0.0f, top - 1.0f));
  };
  const int first = interval(begin);
  const int last = interval(end);
  const bool constantBelow = begin < 0.0f; // where the slope is 0
  const bool constantAbove = end > top;
  Slopes slopes;
  slopes.depth = this->Depths.over(first, last);
  slopes.depth = constantBelow ? std::min(slopes.depth, this->DepthBelow) : slopes.depth;
  slopes.depth = constantAbove ? std::min(slopes.depth, this->DepthAbove) : slopes.depth;
  if ((constantBelow && this->JumpsBelow) || (constantAbove && this->JumpsAbove)) {
    slopes.half = infinite;
    return slopes;
  }
  for (const Extremes& channel : this->Channels) {
    float smallest = channel.smallest.over(first, last);
    float largest = channel.largest.over(first, last);
    if (constantBelow || constantAbove) {
      smallest = std::min(smallest, 0.0f);
      largest = std::max(largest, 0.0f);
    }
    if (!std::isfinite(smallest) || !std::isfinite(largest)) {
      slopes.half = infinite;
      return slopes;
    }
    slopes.middle = std::max(slopes.middle, 0.5f * std::abs(smallest + largest));
    slopes.half = std::max(slopes.half, 0.5f * (largest - smallest));
  }
  float perValue = this->Colors.scale;
  if (this->Colors.logarithmic) {
    const float lowest = this->Colors.valueLow + this->Colors.valueScale * range.low;
    perValue = lowest > 0.0f ? this->Colors.scale * this->Colors.valueScale / lowest : infinite;
    slopes.half += slopes.middle; // the slope of the logarithm is between this and 0
  }
  const auto scaled = [&](float slope) { return slope > 0.0f ? slope * perValue : 0.0f; };
  return {scaled(slopes.middle), scaled(slopes.half), slopes.depth};
}

} // namespace inr
