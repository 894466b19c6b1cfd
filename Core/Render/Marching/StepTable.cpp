// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Marching/StepTable.h"

#include "Core/Render/MacroCells/CellBlock.h"
#include "Core/Render/Scene/Opacity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace inr {

namespace {

constexpr int MaximumRows = 1 << 14;
constexpr float SteepFrom = 0.5f;         // opacity of a unit; rows follow what is below
constexpr double OpacityTolerance = 2e-4; // of a sample's opacity: errors of a ray's samples add up
constexpr double SteepTolerance = 1e-2;   // the same where little of a ray is

/// Whether linear interpolation misses the corrected opacity in the middle of an interval.
bool IsTooLong(double begin, double end, double length)
{
  const double chord = 0.5 * (OpacityOver(length, begin) + OpacityOver(length, end));
  const double curve = OpacityOver(length, 0.5 * (begin + end));
  return std::abs(curve - chord) > OpacityTolerance * curve;
}

/// Whether it does not for any length from a unit distance on. It misses rise^2 / 8 times the
/// second derivative L (L - 1) (1 - opacity)^(L - 2), which is below 2.5 / opacity^2 up to 0.9,
/// whatever L is, and the corrected opacity is not below the opacity.
bool IsShortForAll(double begin, double end)
{
  const double least = std::min(begin, end);
  const double rise = end - begin;
  return std::max(begin, end) <= 0.9 &&
         rise * rise * 2.5 / 8 <= OpacityTolerance * least * least * least;
}

/// Rows between two entries of the colour table.
int Refinement(const ColorLookup& colors, const std::vector<double>& lengths)
{
  int pieces = 1;
  const auto refineFor = [&](double begin, double rise, double length) {
    while (pieces * 2 * (colors.count - 1) <= MaximumRows &&
           (IsTooLong(begin, begin + rise / pieces, length) ||
            IsTooLong(begin + rise - rise / pieces, begin + rise, length))) {
      pieces *= 2;
    }
  };
  for (int k = 0; k + 1 < colors.count; ++k) {
    const double begin = colors.entries[k].w;
    const double end = colors.entries[k + 1].w;
    if (begin == end) {
      continue;
    }
    // Of lengths below a unit distance the shortest bends most.
    refineFor(begin, end - begin, lengths.front());
    if (!IsShortForAll(begin, end)) {
      for (const double length : lengths) {
        refineFor(begin, end - begin, length);
      }
    }
  }
  return pieces;
}

/// Whether that of a row misses the corrected opacity, of which there is `corrected` at its ends.
/// What else bends much is where opacity is high.
bool IsSteep(float begin, float end, double length, const glm::vec4 (&corrected)[2])
{
  if (length >= 1.0 || begin == end || std::max(begin, end) <= SteepFrom) {
    return false;
  }
  const double chord = 0.5 * (corrected[0].w + corrected[1].w);
  const double curve = OpacityOver(length, 0.5 * (static_cast<double>(begin) + end));
  return std::abs(curve - chord) > SteepTolerance * curve;
}

/// Marks the higher row wherever two are too far apart: of all entries but those outside.
void MarkSteep(const std::vector<glm::vec4>& rows, double length, glm::vec4* corrected)
{
  std::vector<std::size_t> steep;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    if (IsSteep(rows[k].w, rows[k + 1].w, length, {corrected[k], corrected[k + 1]})) {
      steep.push_back(rows[k].w > rows[k + 1].w ? k : k + 1);
    }
  }
  for (const std::size_t row : steep) {
    corrected[row].w = SteepEntry * rows[row].w;
  }
}

glm::vec4 Corrected(const glm::vec4& entry, double length)
{
  return {entry.x, entry.y, entry.z, static_cast<float>(OpacityOver(length, double{entry.w}))};
}

} // namespace

float SteepOpacityOf(const StepLookup& lookup, int length, float first, float second, float weight)
{
  return SteepOpacity(first, second, weight, UnitsOf(lookup, length));
}

int SampleLengths(int levels)
{
  return std::max(LengthOf(4, levels - 1), LengthOf(1, LargestCellPower)) + 1;
}

StepTable::StepTable(const ColorLookup& colors, double stepLength, int lengths)
    : StepLength(stepLength), Lengths(lengths)
{
  std::vector<double> inUnits; // of the lengths
  inUnits.reserve(static_cast<std::size_t>(lengths));
  for (int number = 0; number < lengths; ++number) {
    inUnits.push_back(stepLength * static_cast<double>(StepsOf(number)));
  }
  const int pieces = Refinement(colors, inUnits);
  const int nodes = (colors.count - 1) * pieces + 1;
  this->Lookup.rows = nodes + 4;
  // A logarithm is taken before the lookup; what comes here is the coordinate itself.
  const auto rows = static_cast<float>(pieces);
  this->Lookup.scale = colors.logarithmic ? rows : rows * colors.scale;
  this->Lookup.bias = (colors.logarithmic ? 0.0f : rows * colors.bias) + 2.0f;
  this->Entries.reserve(static_cast<std::size_t>(this->Lookup.rows) * lengths);
  std::vector<glm::vec4> between;
  for (int k = 0; k < nodes; ++k) {
    const int cell = std::min(k / pieces, colors.count - 2);
    const auto weight = static_cast<float>(k - cell * pieces) / static_cast<float>(pieces);
    between.push_back(glm::mix(colors.entries[cell], colors.entries[cell + 1], weight));
  }
  for (const double length : inUnits) {
    this->Entries.insert(this->Entries.end(), 2, Corrected(colors.below, length));
    const std::size_t first = this->Entries.size();
    for (const glm::vec4& entry : between) {
      this->Entries.push_back(Corrected(entry, length));
    }
    MarkSteep(between, length, this->Entries.data() + first);
    this->Entries.insert(this->Entries.end(), 2, Corrected(colors.above, length));
  }
  this->Lookup.entries = &this->Entries.data()->x;
  this->Lookup.step = static_cast<float>(stepLength);
}

} // namespace inr
