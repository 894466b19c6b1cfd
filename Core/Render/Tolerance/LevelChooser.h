// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MacroCells/CellBlock.h"
#include "Core/Render/Tolerance/CellMeasurement.h"
#include "Core/Render/Tolerance/LookAhead.h"
#include "Core/Render/Tolerance/PixelErrors.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace inr {

/// Chooses for every macro-cell that can be seen the fewest samples, from the coarsest level of the
/// cache or the full resolution, that change next to no pixel by more than a tolerance; see
/// Frame::errorTolerance, and ErrorTolerance.md for why that holds, and how far.
///
/// CellMeasurement finds what samples of cells get wrong, PixelErrors what that does to a pixel,
/// LookAhead how much of it each cell may do. Cells that no ray of LookAhead meets have every
/// sample, from the full resolution. Where measuring would take too long, samples are judged by the
/// ranges of their cells alone.
class LevelChooser
{
public:
  /// Voxels: where samples are further apart than that, what they leave out is not known.
  static constexpr double LongestStep = 1.0;

  /// Whether a frame's tolerance chooses anything; else it is drawn as with 0. `rangesHold`: of the
  /// field, see MacroCells.
  static bool choosesFor(const Frame& frame, bool rangesHold);

  /// Of a tolerance, what is made use of. The rest is for pixels between the rays that look ahead;
  /// for lines between those that are looked at there is PixelErrors::Unseen.
  static constexpr double MadeUseOf = 0.9;

  /// `levels`: of the cache. `cells` is kept.
  LevelChooser(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
               const Majorants& cells, int levels, const LineKernel& kernel);
  LevelChooser(const LevelChooser&) = delete;
  LevelChooser& operator=(const LevelChooser&) = delete;

  /// What a choice depends on beyond the field and the colours.
  struct Wish
  {
    double tolerance;  ///< of a pixel's channels, 255 = white; above 0
    double step;       ///< t between samples of level 0
    double stepLength; ///< the same in opacity unit distances

    bool operator==(const Wish& other) const
    {
      return this->tolerance == other.tolerance && this->step == other.step &&
             this->stepLength == other.stepLength;
    }
  };
  using View = LookAhead::View;

  /// `majorants`: of the cells given, with the extinctions of `colors`. Measures first what is not
  /// known of cells that can be seen, at least a block on each thread, as far as a time limit
  /// allows: false if that was not all, and sampling() is of no use. It depends on nothing but the
  /// arguments. Throws Error(Cancelled) when `keepGoing` says so.
  bool choose(const Wish& wish, const View& view, const Majorants& majorants,
              const ColorLookup& colors, const Arena& arena, const WorkLimit& limit,
              const std::function<bool()>& keepGoing);
  /// For when these or their extinctions change.
  void forgetColors() { this->IsCurrent = false; }

  /// Points that the field has been asked for so far.
  std::int64_t measuredPoints() const { return this->Measurement.points(); }

  /// Of each cell, x fastest.
  const CellSampling* sampling() const { return this->Sampling.data(); }

private:
  void prepare(const Wish& wish, const View& view, const ColorLookup& colors, const Arena& arena);
  void lookAhead(const View& view, const Majorants& majorants, const Arena& arena);
  /// Whether all were.
  bool measure(const std::vector<std::int64_t>& blocks, const Arena& arena, const WorkLimit& limit,
               const std::function<bool()>& keepGoing);
  void chooseSamples(const Arena& arena);

  glm::dvec3 Dims;
  int Coarsest;
  CellMeasurement Measurement;
  PixelErrors Errors;
  LookAhead Rays;
  Wish Given{};
  bool IsCurrent = false; ///< whether all is for that and for the colours
  std::vector<CellSampling> Sampling;
};

} // namespace inr
