// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/ColorTable.h"

#include "Core/Error.h"
#include "Core/Render/Scene/Opacity.h"

#include <algorithm>
#include <limits>

namespace inr {

namespace {

bool IsColour(const glm::vec4& entry)
{
  return std::isfinite(entry.x) && std::isfinite(entry.y) && std::isfinite(entry.z) &&
         entry.w >= 0.0f && entry.w <= 1.0f;
}

void Check(const TransferFunction& function)
{
  const auto require = [](bool condition, const char* message) {
    if (!condition) {
      throw Error(ErrorCode::InvalidArgument, message);
    }
  };
  // These take some 30 MiB for samples of all lengths (StepTable), outside of a cache's budget.
  require(function.table.size() >= 2 && function.table.size() <= (1u << 16),
          "a transfer function needs 2 to 65536 table entries");
  require(std::isfinite(function.low) && std::isfinite(function.high) &&
              function.low < function.high,
          "a transfer function needs a range with low < high");
  require(!function.logarithmic || function.low > 0,
          "a logarithmic transfer function needs a positive range");
  require(IsColour(function.below) && IsColour(function.above) &&
              std::all_of(function.table.begin(), function.table.end(), IsColour),
          "a transfer function's colours must be finite and its opacities in [0, 1]; on a "
          "logarithmic scale, none of its points may be at 0 or below");
}

/// Wider than a double where the platform has that: differences and ratios of denormal or of the
/// largest numbers overflow.
using Wide = long double;

/// No infinity may come out, nor a NaN of two: what is further than that is as good as there.
float Finite(Wide value)
{
  constexpr Wide largest = 1e30L; // there is room for what tables multiply by
  return static_cast<float>(std::clamp(value, -largest, largest));
}

/// A logarithmic table over a range as narrow as that, compared with its lowest value, is drawn as
/// a linear one: they differ by 1.25e-4 of the table at most, about what floats leave of logarithms
/// of numbers so close to 1.
constexpr double NarrowRange = 1e-3;

bool IsNarrow(const TransferFunction& function)
{
  return Wide{function.high} - function.low < NarrowRange * Wide{function.low};
}

/// By what values are divided before their logarithm is taken: the table's lowest one, whose
/// logarithm is 0 then, or, where float cannot hold the others, the largest.
Wide LogarithmicUnit(const TransferFunction& function, const VolumeInfo& volume)
{
  constexpr Wide most = 1e29L; // and there may be as much on either side of 0
  const Wide largest = std::max(std::abs(volume.low), std::abs(volume.high));
  return largest < most * function.low || largest <= 0 ? Wide{function.low} : largest;
}

/// So that no rounding takes the volume's highest value for one above the table, here or where
/// logarithms are rounded otherwise. Logarithmic tables that it ends with are shorter by 4e-7 of
/// their length for that, and by what rounding had added.
void KeepHighInside(ColorLookup& lookup)
{
  const auto last = static_cast<float>(lookup.count - 1);
  if (lookup.logarithmic) {
    const float end = last * (1 - 4e-7f);
    const float shorter = end / std::max(lookup.coordinate(1.0f), end);
    lookup.scale *= shorter;
    lookup.bias *= shorter;
    return;
  }
  lookup.bias = std::min(lookup.bias, last);
  lookup.scale -= std::max(lookup.coordinate(1.0f) - last, 0.0f);
  while (lookup.coordinate(1.0f) > last) {
    lookup.scale = std::nextafter(lookup.scale, -std::numeric_limits<float>::infinity());
  }
}

/// Nor its lowest one for one below.
void KeepLowInside(ColorLookup& lookup)
{
  // Further below, it is beyond what float holds.
  while (lookup.coordinate(0.0f) < 0.0f && lookup.coordinate(0.0f) > -1.0f) {
    lookup.bias = std::nextafter(lookup.bias, std::numeric_limits<float>::infinity());
  }
}

void MapLinearly(const TransferFunction& function, const VolumeInfo& volume, ColorLookup& lookup)
{
  const Wide last = static_cast<Wide>(lookup.count - 1);
  const Wide range = Wide{function.high} - function.low;
  lookup.scale = Finite(last * ((Wide{volume.high} - volume.low) / range));
  lookup.bias = Finite(last * ((Wide{volume.low} - function.low) / range));
}

void MapLogarithms(const TransferFunction& function, const VolumeInfo& volume, ColorLookup& lookup)
{
  const Wide unit = LogarithmicUnit(function, volume);
  const Wide last = static_cast<Wide>(lookup.count - 1);
  const Wide scale = last / std::log(Wide{function.high} / function.low);
  lookup.scale = Finite(scale);
  lookup.bias = Finite(-scale * std::log(function.low / unit));
  lookup.valueLow = Finite(volume.low / unit);
  lookup.valueScale = Finite((Wide{volume.high} - volume.low) / unit);
}

/// How normalised values of a volume become table coordinates; see ColorLookup::coordinate.
void MapValues(const TransferFunction& function, const VolumeInfo& volume, ColorLookup& lookup)
{
  lookup.logarithmic = function.logarithmic && !IsNarrow(function);
  if (lookup.logarithmic) {
    MapLogarithms(function, volume, lookup);
  } else {
    MapLinearly(function, volume, lookup);
  }
  if (volume.high <= function.high) {
    KeepHighInside(lookup);
  }
  if (volume.low >= function.low) {
    KeepLowInside(lookup);
  }
}

} // namespace

ColorTable::ColorTable(const TransferFunction& function, const VolumeInfo& volume)
    : Entries(function.table), Below(ExtinctionOf(function.below.w)),
      Above(ExtinctionOf(function.above.w))
{
  Check(function);
  ColorLookup& lookup = this->Lookup;
  lookup.entries = this->Entries.data();
  lookup.count = static_cast<int>(this->Entries.size());
  lookup.below = function.below;
  lookup.above = function.above;
  MapValues(function, volume, lookup);
  std::vector<float> extinctions;
  for (const glm::vec4& entry : this->Entries) {
    extinctions.push_back(ExtinctionOf(entry.w));
  }
  this->Extinctions = SparseTable<Maximum>(std::move(extinctions));
}

bool ColorTable::hidesAny() const
{
  const std::vector<float>& extinctions = this->Extinctions.values();
  return this->Below <= 0.0f || this->Above <= 0.0f ||
         *std::min_element(extinctions.begin(), extinctions.end()) <= 0.0f;
}

float ColorTable::maximumExtinction(const ValueRange& range) const
{
  if (range.empty()) {
    return 0.0f;
  }
  // Between nodes opacity is linear: its extremes are at the nodes inside and at the two ends.
  // Taking the nodes just outside instead of the ends also covers the rounding of the coordinate.
  const float begin = this->Lookup.coordinate(range.low);
  const float end = this->Lookup.coordinate(range.high);
  const auto top = static_cast<float>(this->Lookup.count - 1);
  float maximum = 0.0f;
  if (begin <= 0.0f) {
    maximum = std::max(maximum, this->Below);
  }
  if (end >= top) {
    maximum = std::max(maximum, this->Above);
  }
  if (end < -1.0f || begin > top + 1.0f) {
    return maximum;
  }
  const int first = static_cast<int>(std::clamp(begin, 0.0f, top));
  const float inside = std::clamp(end, 0.0f, top);
  const int before = static_cast<int>(inside);
  const int last = static_cast<float>(before) < inside ? before + 1 : before;
  return std::max(maximum, this->Extinctions.over(first, last));
}

void ColorTable::maximumExtinctions(const ValueRange* ranges, std::int64_t count,
                                    float* extinctions) const
{
  for (std::int64_t k = 0; k < count; ++k) {
    extinctions[k] = this->maximumExtinction(ranges[k]);
  }
}

} // namespace inr
