// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/LevelErrors.h"
#include "Core/Render/CellBlock.h"
#include "Core/Render/ColorSensitivity.h"
#include "Core/Render/Majorants.h"
#include "Core/Render/Ray.h"
#include "Core/Render/WorkLimit.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace inr {

/// Chooses for every macro-cell that can be seen the fewest samples, from the coarsest level of the
/// cache or the full resolution, that change next to no pixel by more than a tolerance; see
/// Frame::errorTolerance.
///
/// A sample that stands for n steps is in their middle. LevelErrors says by how much the sum of
/// samples along any part of a line through a cell may be off, ColorSensitivity by how much that
/// changes a pixel. What lies in front of a sample hides a part of it, and never less than of those
/// before, so that errors which cancel each other still do (Abel's inequality). What cells add is
/// added up along a ray, whatever its signs. That is done for a grid of pixels, at most 48 across
/// what the volume covers, as if rays went all through the cells that they meet: each finds the
/// largest error to a step that all of its cells together may have, and a cell is allowed the least
/// that any ray through it found. Cells that none of these rays meets have every sample, from the
/// full resolution, as have those that would take too long to measure.
class LevelChooser
{
public:
  /// Only where so much has to be measured, or less, as LevelErrors::blockCost counts: some minutes
  /// of work.
  static constexpr std::int64_t MostVoxels = std::int64_t{1} << 31;
  /// And so much at once.
  static constexpr std::int64_t LargestBlock = std::int64_t{1} << 24;
  /// And only so many cells: 160 MiB. More are known as long as there are no more in all.
  static constexpr std::int64_t MostCells = std::int64_t{1} << 21;

  /// Voxels: where samples are further apart than that, what they leave out is not known.
  static constexpr double LongestStep = 1.0;

  /// Of a tolerance, what is made use of: lines between the directions that LevelErrors looks at
  /// may be further off. With it, the worst of 1,170 pictures that are hard to keep to, of fields
  /// linear between voxels, was off by 0.96 of the tolerance.
  static constexpr double Certain = 0.8;

  /// `levels`: of the cache.
  LevelChooser(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
               const MajorantGrid& cells, int levels, const LineKernel& kernel);

  /// What a choice depends on beyond the field and the colours.
  struct Wish
  {
    double tolerance;  ///< of a pixel's channels, 1 = white; above 0
    double step;       ///< t between samples of level 0
    double stepLength; ///< the same in opacity unit distances

    bool operator==(const Wish& other) const
    {
      return this->tolerance == other.tolerance && this->step == other.step &&
             this->stepLength == other.stepLength;
    }
  };
  struct View
  {
    const RayGeometry& geometry;
    int width; ///< pixels
    int height;
  };

  /// `majorants`: whose extinctions are those of `colors`. Measures first what is not known of
  /// cells that can be seen, at least a block on each thread, as far as a time limit allows: false
  /// if that was not all, and sampling() is of no use. It depends on nothing but the arguments.
  /// Throws Error(Cancelled) when `keepGoing` says so.
  bool choose(const Wish& wish, const View& view, const Majorants& majorants,
              const ColorLookup& colors, const Arena& arena, const WorkLimit& limit,
              const std::function<bool()>& keepGoing);
  /// For when these or their extinctions change.
  void forgetColors() { this->IsCurrent = false; }

  /// Points that the field has been asked for so far.
  std::int64_t measuredPoints() const { return this->Points; }

  /// Of each cell, x fastest.
  const CellSampling* sampling() const { return this->Sampling.data(); }

private:
  static constexpr std::size_t LimitCount = 24;

  /// What a cell may add to a pixel's error if its samples are not all of the full resolution.
  struct CellError
  {
    double all = 0;     ///< steps times their length in voxels: of a ray that goes all through it
    double step = 0;    ///< of any one step
    double perStep = 0; ///< in the mean of those through its longest edge
  };
  /// What a cell's samples may be, from the fewest on: of a level with as large voxels as they are
  /// apart, then of the full resolution; and behind these, all.
  static constexpr int Choices = 2 * LargestCellPower;
  static CellSampling choice(int number)
  {
    const auto power = static_cast<std::uint8_t>((Choices + 1 - number) / 2);
    return {number % 2 == 0 ? power : std::uint8_t{0}, power};
  }
  static int numberOf(const CellSampling& choice)
  {
    return Choices - 2 * choice.power + (choice.level == 0 ? 1 : 0);
  }
  using CellErrors = std::array<CellError, Choices>;
  struct RayWalk;

  void findSlopes(const MajorantGrid& cells, const ColorLookup& colors, const Arena& arena);
  /// Finds the cells that rays meet, and what they can bear there.
  void sendRays(const View& view, const Majorants& majorants, const Arena& arena);
  void follow(const Ray& ray, const Majorants& majorants, RayWalk& walk);
  /// What sendRays says of a block.
  enum Need : std::uint8_t { NotSeen, Seen, NotKnown };
  /// Those with that much need, or more.
  std::vector<std::int64_t> blocksWith(Need need) const;
  LevelErrors::Question question(const MajorantGrid& cells) const;
  /// Whether a cell's samples may be off by more than what counts at all, and not by anything.
  bool canMatter(std::int64_t cell, const ValueRange& range) const;
  /// Whether all were.
  bool measure(const std::vector<std::int64_t>& blocks, const MajorantGrid& cells,
               const Arena& arena, const WorkLimit& limit, const std::function<bool()>& keepGoing);
  bool areTooMany(std::int64_t blocks) const;
  void forgetOthersThan(const std::vector<std::int64_t>& seen);
  void chooseLevels(const MajorantGrid& cells, const Arena& arena);
  CellErrors errorsOf(std::int64_t cell, const ValueRange& range) const;
  CellError errorOf(std::int64_t cell, const LineErrors& lines, double most) const;
  /// The number of the first choice from `first` on whose steps add no more than that.
  static int choiceFor(const CellErrors& errors, double limit, int first);
  void setLimits();

  std::shared_ptr<const Evaluator> Field;
  const LineKernel& Kernel;
  glm::dvec3 Dims;
  LevelErrors Errors;
  int Coarsest;
  double LongestEdge; ///< of a cell, in voxels
  std::int64_t Points = 0;
  double SecondsPerRound = 0.1; ///< of measuring a block on each thread: a guess at first
  Wish Given{};
  bool IsCurrent = false; ///< whether all below is for that and for the colours
  double LeastError = 0;  ///< of a step, that matters at all
  /// log2 of the voxels that samples of the full resolution are apart with 2, 4, ... steps between
  /// them, rounded up, and at least 1.
  std::array<int, LargestCellPower> Apart{};
  bool UsesMeasured = true;
  std::array<double, LimitCount + 1> Limits{};  ///< of what a step may add, falling to 0
  std::vector<ColorSensitivity::Slopes> Slopes; ///< of each cell
  std::unique_ptr<std::atomic<std::uint8_t>[]>
      Allowed; ///< of each cell, 1 + the number of its limit; 0: not met
  std::unique_ptr<std::atomic<std::uint8_t>[]> Needs; ///< of each block
  std::vector<CellSampling> Sampling;
};

} // namespace inr
