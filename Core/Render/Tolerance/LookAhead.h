// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MacroCells/Majorants.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Tolerance/LevelErrors.h"
#include "Core/Render/Tolerance/PixelErrors.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace inr {

class Arena;

/// Finds how much a step in each macro-cell may add to a pixel's error: sends rays through a grid
/// of pixels, and each allows all of its cells the largest error per step with which what they add
/// together stays within a tolerance. A cell is allowed the least that any ray through it allows,
/// and nothing where none of them comes by. Steps 4 and 5 of ErrorTolerance.md.
class LookAhead
{
public:
  LookAhead(std::int64_t cells, std::int64_t blocks);

  /// Of a pixel's channels, 1 = white.
  void setTolerance(double tolerance);

  struct View
  {
    const RayGeometry& geometry;
    int width; ///< pixels
    int height;
  };
  struct Scene
  {
    const Majorants& majorants;
    const PixelErrors& errors;
    const LevelErrors& measured;
    /// How far cells that are seen ought to be measured.
    const LevelErrors::Question& question;
    glm::dvec3 dims; ///< voxels
    double step;     ///< t between samples of level 0
  };
  void send(const View& view, const Scene& scene, const Arena& arena);

  /// The most that is ever allowed.
  double largestLimit() const { return this->Allowable[0]; }
  bool meets(std::int64_t cell) const { return this->Allowed[static_cast<std::size_t>(cell)] > 0; }
  /// What a cell that rays meet is allowed.
  double limit(std::int64_t cell) const
  {
    return this->Allowable[this->Allowed[static_cast<std::size_t>(cell)] - 1u];
  }

  /// What the last rays say of a block of cells: whether they see one that matters, and whether
  /// one of these is not known as far as it ought to be.
  enum Need : std::uint8_t { NotSeen, Seen, NotKnown };
  /// Those with that much need, or more, in order.
  std::vector<std::int64_t> blocksWith(Need need) const;

private:
  /// Limits are the tolerance, which a single step may have all of, and half octaves below it. The
  /// last is for 2,900 steps that nothing hides and that are all as much off: the diagonal of 800^3
  /// voxels, half a voxel apart. Where that is too much, all samples are taken.
  static constexpr std::size_t LimitCount = 24;
  using Limits = std::array<double, LimitCount + 1>; ///< falling, and at last 0
  struct Walk;

  void follow(const Ray& ray, const Scene& scene, Walk& walk);
  /// The rectangle of pixels that the volume covers, a grid's distance more on each side.
  static std::array<glm::ivec2, 2> seenPart(const View& view);

  double Tolerance = 0;
  Limits Allowable{}; ///< errors of a step
  std::int64_t Cells;
  std::int64_t Blocks;
  std::unique_ptr<std::atomic<std::uint8_t>[]>
      Allowed; ///< of each cell, 1 + the number of its limit; 0: not met
  std::unique_ptr<std::atomic<std::uint8_t>[]> Needs; ///< of each block
};

} // namespace inr
