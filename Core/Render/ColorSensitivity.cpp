// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/ColorSensitivity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace inr {

namespace {

/// What a step's premultiplied colour and opacity change by per table entry where they are `at`,
/// and straight colour and opacity change by `change`.
glm::dvec4 StepSlope(const glm::dvec4& at, const glm::dvec4& change, double stepLength)
{
  const double transmittance = std::log1p(-at.w); // of a unit distance, its logarithm
  const double opacity = -std::expm1(transmittance * stepLength);
  const double slope =
      change.w == 0 ? 0.0 : change.w * stepLength * std::exp(transmittance * (stepLength - 1.0));
  return {glm::dvec3(change) * opacity + glm::dvec3(at) * slope, slope};
}

std::vector<std::vector<float>> Doubled(std::vector<float> single,
                                        const float& (*choose)(const float&, const float&))
{
  const std::size_t count = single.size();
  std::vector<std::vector<float>> rows{std::move(single)};
  for (std::size_t span = 2; span <= count; span *= 2) {
    const std::vector<float>& half = rows.back();
    std::vector<float> row(count - span + 1);
    for (std::size_t k = 0; k < row.size(); ++k) {
      row[k] = choose(half[k], half[k + span / 2]);
    }
    rows.push_back(std::move(row));
  }
  return rows;
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
  // Of each channel in front of black, of each colour in front of white. Between two entries slopes
  // are between those at either.
  std::vector<float> smallest[7];
  std::vector<float> largest[7];
  for (std::size_t k = 0; k < last; ++k) {
    const glm::dvec4 change = glm::dvec4(entries[k + 1]) - glm::dvec4(entries[k]);
    const glm::dvec4 begin = StepSlope(entries[k], change, stepLength);
    const glm::dvec4 end = StepSlope(entries[k + 1], change, stepLength);
    for (int row = 0; row < 7; ++row) {
      const int channel = row % 4;
      const double first = row < 4 ? begin[channel] : begin[channel] - begin.w;
      const double second = row < 4 ? end[channel] : end[channel] - end.w;
      smallest[row].push_back(static_cast<float>(std::min(first, second)));
      largest[row].push_back(static_cast<float>(std::max(first, second)));
    }
  }
  for (int row = 0; row < 7; ++row) {
    this->Channels.push_back({Doubled(std::move(smallest[row]), std::min<float>),
                              Doubled(std::move(largest[row]), std::max<float>)});
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
  if ((begin <= 0.0f && end >= 0.0f && this->JumpsBelow) ||
      (begin <= top && end >= top && this->JumpsAbove)) {
    return {0, infinite};
  }
  if (end < 0.0f || begin > top) {
    return {};
  }
  const auto interval = [&](float coordinate) {
    return static_cast<int>(std::clamp(coordinate, 0.0f, top - 1.0f));
  };
  const int first = interval(begin);
  const int last = interval(end);
  const auto row =
      static_cast<std::size_t>(31 - __builtin_clz(static_cast<unsigned>(last - first + 1)));
  const auto left = static_cast<std::size_t>(first);
  const auto right = static_cast<std::size_t>(last + 1 - (1 << row));
  const bool constantBelow = begin < 0.0f; // where the slope is 0
  const bool constantAbove = end > top;
  Slopes slopes;
  for (const Extremes& channel : this->Channels) {
    float smallest = std::min(channel.smallest[row][left], channel.smallest[row][right]);
    float largest = std::max(channel.largest[row][left], channel.largest[row][right]);
    if (constantBelow || constantAbove) {
      smallest = std::min(smallest, 0.0f);
      largest = std::max(largest, 0.0f);
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
  return {scaled(slopes.middle), scaled(slopes.half)};
}

} // namespace inr
