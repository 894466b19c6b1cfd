// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/ModelSize.h"

#include "Core/Training/Trainer.h"

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// Parameters that the file may hold for a volume of `voxels` when nobody names a ratio: grows with
/// the root of the voxels, which gives 13:1 for 91^3 floats and 6,000:1 for 4096^3.
double DefaultParameters(double voxels) { return 128.0 * std::sqrt(voxels); }

/// When nobody names a ratio, the parameters take at most half of the volume's bytes, down to the
/// smallest model: the file of a volume of a few thousand voxels can be larger than the volume.
constexpr double SmallestRatio = 2.0;

/// Trained models take 0.5 to 0.7 bytes a parameter when 0.1 dB may be lost. A larger model with
/// coarser steps is better than that, though: on rm_mixing (60:1) and les_wmag91 (40:1), 0.33 to
/// 0.48 bytes gave about 1 dB more than 0.55 to 0.63. The better the fit, the more digits count.
constexpr double QuantisedBytes = 0.5;

double BytesPerParameter(ParameterType storedAs)
{
  switch (storedAs) {
  case ParameterType::Half:
    return 2.0;
  case ParameterType::Float:
    return 4.0;
  default:
    return QuantisedBytes;
  }
}

constexpr double DefaultBytes = 2.0; // of a parameter: sizes are the same in every precision
constexpr double FramingBytes = 2048.0;

double ParameterBudget(const glm::i64vec3& dims, ScalarType type, double ratio,
                       ParameterType storedAs, int macroCellSize)
{
  const double voxels =
      static_cast<double>(dims.x) * static_cast<double>(dims.y) * static_cast<double>(dims.z);
  const double bytes = voxels * static_cast<double>(ScalarSize(type));
  if (ratio <= 0.0) {
    return std::min(DefaultParameters(voxels), bytes / SmallestRatio / DefaultBytes);
  }
  const int edge = macroCellSize > 0 ? macroCellSize : DefaultMacroCellSize(dims);
  const std::int64_t cells = CountMacroCells(dims, edge);
  const double cellBytes = storedAs == ParameterType::Quantised ? ExpectedRangeBytes(edge, cells)
                                                                : 8.0 * static_cast<double>(cells);
  return (bytes / ratio - cellBytes - FramingBytes) / BytesPerParameter(storedAs);
}

/// Neighbouring levels' resolutions: more levels fit better for the same file than doubling does.
constexpr float LevelGrowth = 1.5f;
constexpr int BaseResolution = 8;
constexpr int MostLevels = 16;

/// Enough levels to reach the volume's longest side.
int LevelsFor(const glm::i64vec3& dims)
{
  const auto longest = static_cast<double>(std::max({dims.x, dims.y, dims.z}));
  const double steps = std::log(std::max(1.0, longest / BaseResolution)) / std::log(LevelGrowth);
  return std::clamp(static_cast<int>(std::ceil(steps)) + 1, 2, MostLevels);
}

bool Fits(const Description& description, double budget)
{
  return static_cast<double>(Layout(description).parameterCount) <= budget;
}

/// The largest table that fits; the smallest one when nothing does.
Description WithLargestTable(Description description, double budget)
{
  description.grid.log2HashmapSize = 6;
  for (int log2Size = 7; log2Size <= 22; ++log2Size) {
    Description candidate = description;
    candidate.grid.log2HashmapSize = log2Size;
    if (!Fits(candidate, budget)) {
      break;
    }
    description = candidate;
  }
  return description;
}

/// As many levels between the coarsest and the finest as fit: tables come in powers of two, which
/// would leave up to half of the budget unused.
Description WithMoreLevels(Description description, double budget)
{
  const double intervals = description.grid.levels - 1; // of LevelGrowth
  for (int levels = description.grid.levels + 1; levels <= MostLevels; ++levels) {
    Description candidate = description;
    candidate.grid.levels = levels;
    candidate.grid.perLevelScale = static_cast<float>(
        std::pow(static_cast<double>(LevelGrowth), intervals / static_cast<double>(levels - 1)));
    if (!Fits(candidate, budget)) {
      break;
    }
    description = candidate;
  }
  return description;
}

} // namespace

Description ChooseDescription(const glm::i64vec3& dims, ScalarType type, double ratio,
                              ParameterType storedAs, int macroCellSize)
{
  const double budget = ParameterBudget(dims, type, ratio, storedAs, macroCellSize);
  Description description;
  description.grid.features = 4;
  description.grid.baseResolution = BaseResolution;
  description.grid.perLevelScale = LevelGrowth;
  description.grid.levels = LevelsFor(dims);
  description.network.neurons = budget < 2e4 ? 16 : budget < 2e6 ? 32 : 64;
  description.network.hiddenLayers = 2;
  return WithMoreLevels(WithLargestTable(description, budget), budget);
}

} // namespace inr
