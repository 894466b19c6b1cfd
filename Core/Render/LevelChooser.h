// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/LevelErrors.h"
#include "Core/Render/ColorSensitivity.h"
#include "Core/Render/MajorantGrid.h"
#include "Core/Render/WorkLimit.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace inr {

/// Chooses for every macro-cell the coarsest level of the cache that changes no pixel by more than
/// a tolerance; see Frame::errorTolerance.
///
/// A sample of level l stands for 2^l steps and is in their middle. LevelErrors says by how much
/// the worst line of them through a cell is off, ColorSensitivity by how much that changes a pixel
/// at most. Cells along a ray do not err together, and most lines are not the worst, so n cells are
/// each given 4/sqrt(n) of the tolerance: a matter of experience, not of proof
/// (Testing/Benchmarks/tolerance.py), which keeps to the tolerance in 99.9 % of the pixels. Before
/// a cell is measured, or where measuring would take too long, nothing is known but that all values
/// are in its range.
class LevelChooser
{
public:
  /// Only up to so many voxels are measured: some minutes of work.
  static constexpr std::int64_t MostVoxels = std::int64_t{1} << 31;
  /// And so many at once.
  static constexpr std::int64_t LargestBlock = std::int64_t{1} << 24;

  /// `levels`: of the cache.
  LevelChooser(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
               const MajorantGrid& cells, int levels);

  /// What a choice depends on beyond the field.
  struct Wish
  {
    double tolerance;  ///< of a pixel's channels, 1 = white; 0: nothing but level 0
    double step;       ///< between samples of level 0, in voxels
    double stepLength; ///< the same in opacity unit distances
    double steps;      ///< of the longest ray

    bool operator==(const Wish& other) const
    {
      return this->tolerance == other.tolerance && this->step == other.step &&
             this->stepLength == other.stepLength && this->steps == other.steps;
    }
  };

  enum class Outcome {
    Same,    ///< nothing has changed since the last call
    Changed, ///< levels() are others now
    Partial  ///< they are as coarse as was found in time; asking again may find coarser ones
  };

  /// `cells`: whose extinctions are those of `colors`. Measures first what is not known of cells
  /// that can be seen, unless a time limit leaves no time for that. Throws Error(Cancelled) when
  /// `keepGoing` says so.
  Outcome choose(const Wish& wish, const MajorantGrid& cells, const ColorLookup& colors,
                 const Arena& arena, const WorkLimit& limit,
                 const std::function<bool()>& keepGoing);
  /// For when these or their extinctions change.
  void forgetColors() { this->Chosen.reset(); }

  /// Points that the field has been asked for so far.
  std::int64_t measuredPoints() const { return this->Points; }

  /// Of each cell, x fastest.
  const std::uint8_t* levels() const { return this->Levels.data(); }

private:
  void findSlopes(const Wish& wish, const MajorantGrid& cells, const ColorLookup& colors,
                  const Arena& arena);
  /// What a step of a cell may add to a pixel's error.
  double allowance(const Wish& wish) const;
  std::vector<std::int64_t> unmeasured(const MajorantGrid& cells, double allowance) const;
  /// Whether all were.
  bool measure(const std::vector<std::int64_t>& blocks, const Arena& arena, const WorkLimit& limit,
               const std::function<bool()>& keepGoing);
  void chooseLevels(const Wish& wish, const MajorantGrid& cells, const Arena& arena);
  double errorOf(std::int64_t cell, int level, double step) const;
  int levelOf(std::int64_t cell, const ValueRange& range, const Wish& wish, double allowance) const;

  std::shared_ptr<const Evaluator> Field;
  LevelErrors Errors;
  int Coarsest;
  std::int64_t Points = 0;
  double SecondsPerRound = 0.1; ///< of measuring a block on each thread: a guess at first
  std::optional<Wish> Chosen;
  bool Complete = false;
  std::vector<ColorSensitivity::Slopes> Slopes; ///< of each cell
  std::vector<std::uint8_t> Levels;
};

} // namespace inr
