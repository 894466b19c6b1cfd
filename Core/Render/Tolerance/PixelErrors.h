// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MacroCells/Majorants.h"
#include "Core/Render/Marching/SampleChoices.h"
#include "Core/Render/Tolerance/ColorSensitivity.h"
#include "Core/Render/Tolerance/LevelErrors.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace inr {

class Arena;

/// What fewer samples in a macro-cell may change a pixel by, before what lies in front hides a part
/// of it: errors of values along lines (LevelErrors) through slopes of colours (ColorSensitivity).
/// Steps 2 and 3 of ErrorTolerance.md. Channels, 1 = white.
class PixelErrors
{
public:
  /// What lines of voxels add, times that, is taken to be the most that rays add, which may go
  /// where no line that is looked at does: see ErrorTolerance.md, which says how the worst of many
  /// pictures that are hard to keep to was found. Errors of single steps are all looked at.
  static constexpr double Unseen = 1.8;

  struct Error
  {
    double all = 0;     ///< steps times their length in voxels: of a ray that goes all through it
    double step = 0;    ///< of any one step
    double perStep = 0; ///< in the mean of those through its longest edge
  };

  /// Of each choice but all samples, which is off by nothing.
  using Choices = std::array<Error, SampleChoices>;

  /// `measured` and `cells` are kept; `measured` is read at any later time. `coarsest`: level of
  /// the cache.
  PixelErrors(const LevelErrors& measured, const Majorants& cells, int coarsest);

  /// `step`: t between samples of level 0; `stepLength`: the same in opacity unit distances.
  void set(const ColorLookup& colors, double step, double stepLength, const Arena& arena);
  /// Error of a step from which on it matters at all.
  void ignoreBelow(double error) { this->LeastError = error; }
  /// Whether what is measured counts, or a cell's range of values alone.
  void useMeasured(bool uses) { this->UsesMeasured = uses; }

  double longestEdge() const { return this->LongestEdge; } ///< of a cell, in voxels
  /// Of a step of any value in the cell, at least.
  double opticalDepth(std::int64_t cell) const { return this->slopes(cell).depth; }
  /// Whether a cell's samples may be off by more than what counts at all, and not by anything.
  bool canMatter(std::int64_t cell) const
  {
    return this->largestError(cell) > this->LeastError && std::isfinite(this->slopes(cell).half);
  }
  Choices of(std::int64_t cell) const;

  /// Powers of samples further apart that are looked up.
  int powersOfSteps() const { return this->Apart.back(); }
  /// Whether lines of a cell that are so much off, or more, make steps add more than `limit` in the
  /// mean; or whether the cell is none to be measured.
  bool isTooLarge(std::int64_t cell, const LineErrors& lines, double limit) const;

private:
  const ColorSensitivity::Slopes& slopes(std::int64_t cell) const
  {
    return this->Slopes[static_cast<std::size_t>(cell)];
  }
  /// Of a step, whatever it has of the values that samples in the cell can show: those of coarser
  /// levels show what is around it, too.
  double largestError(std::int64_t cell) const
  {
    return this->Largest[static_cast<std::size_t>(cell)];
  }
  const ValueRange& shown(std::int64_t cell) const;
  Error errorOf(std::int64_t cell, const LineErrors& lines, double most) const;

  const LevelErrors& Measured;
  const MajorantGrid& Cells;
  const MajorantGrid& Around; ///< bounds what samples of any level that counts show
  std::int64_t Together;      ///< cells to one of these, along each axis
  int Coarsest;
  double LongestEdge;
  double LeastError = 0;
  bool UsesMeasured = true;
  /// log2 of the voxels that samples of the full resolution are apart with 2, 4, ... steps between
  /// them, rounded up, and at least 1.
  std::array<int, LargestCellPower> Apart{};
  std::vector<ColorSensitivity::Slopes> Slopes; ///< of each cell
  std::vector<float> Largest;                   ///< errors
};

/// The first choice from `first` on whose steps add no more than `limit` in the mean.
inline int FewestSamples(const PixelErrors::Choices& errors, double limit, int first = 0)
{
  while (first < SampleChoices && !(errors[static_cast<std::size_t>(first)].perStep <= limit)) {
    ++first;
  }
  return first;
}

} // namespace inr
