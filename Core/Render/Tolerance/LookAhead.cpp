// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/LookAhead.h"

#include "Core/Parallel.h"
#include "Core/Render/MacroCells/CellWalker.h"
#include "Core/Render/Rays/PixelGrid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

constexpr std::int64_t RaysPerTask = 64;
/// A picture, at most: 48^2 rays take a hundredth of the time that those of 512x512 pixels take,
/// and still meet all that matters of cells a 48th as wide as what is seen; of smaller ones they
/// miss some, which then have all samples.
constexpr int RaysAcross = 48;
/// Light from behind, where rays end. What is further back changes a pixel by no more than so much
/// of its brightest colour: a quarter of a 255th of white.
constexpr double Hidden = 1e-3;

void Raise(std::atomic<std::uint8_t>& number, int to)
{
  std::uint8_t now = number.load(std::memory_order_relaxed);
  while (now < to && !number.compare_exchange_weak(now, static_cast<std::uint8_t>(to))) {
  }
}

template <typename Values> void Clear(const Values& values, std::int64_t count)
{
  for (std::int64_t k = 0; k < count; ++k) {
    values[static_cast<std::size_t>(k)].store(0, std::memory_order_relaxed);
  }
}

} // namespace

/// What the cells along a ray add to its pixel's error, for each of the limits.
struct LookAhead::Walk
{
  void start()
  {
    this->sums.fill(0.0);
    this->cells.clear();
  }

  /// A cell that has the fewest samples that each limit allows. `crossing`: steps through it;
  /// `light`: of what is there, that is seen.
  void add(std::int64_t cell, const PixelErrors::Choices& errors, const Limits& limits,
           double stepsPerVoxel, double crossing, double light)
  {
    this->cells.push_back(cell);
    int number = 0;
    for (std::size_t k = 0; k < LimitCount; ++k) {
      number = FewestSamples(errors, limits[k], number);
      if (number == SampleChoices) {
        return; // nor do smaller limits allow anything
      }
      const PixelErrors::Error& error = errors[static_cast<std::size_t>(number)];
      this->sums[k] += light * std::min(stepsPerVoxel * error.all, crossing * error.step);
    }
  }

  /// The number of the largest limit that keeps to a tolerance, LimitCount if none does.
  int firstWithin(double tolerance) const
  {
    const auto within = std::find_if(this->sums.begin(), this->sums.end(),
                                     [&](double sum) { return sum <= tolerance; });
    return static_cast<int>(within - this->sums.begin());
  }

  std::array<double, LimitCount> sums;
  std::vector<std::int64_t> cells;
};

LookAhead::LookAhead(std::int64_t cells, std::int64_t blocks)
    : Cells(cells), Blocks(blocks),
      Allowed(new std::atomic<std::uint8_t>[static_cast<std::size_t>(cells)]),
      Needs(new std::atomic<std::uint8_t>[static_cast<std::size_t>(blocks)])
{}

void LookAhead::setTolerance(double tolerance)
{
  this->Tolerance = tolerance;
  for (std::size_t k = 0; k < LimitCount; ++k) {
    this->Allowable[k] = tolerance * std::exp2(-0.5 * static_cast<double>(k));
  }
  this->Allowable[LimitCount] = 0;
}

std::array<glm::ivec2, 2> LookAhead::seenPart(const View& view)
{
  const PixelGrid all({0, 0}, {view.width, view.height}, RaysAcross);
  glm::ivec2 low(view.width, view.height);
  glm::ivec2 high(-1);
  for (std::int64_t k = 0; k < all.count(); ++k) {
    const glm::ivec2 pixel = all.pixel(k);
    if (view.geometry.ray(pixel.x, pixel.y).length > 0) {
      low = glm::min(low, pixel - all.apart());
      high = glm::max(high, pixel + all.apart());
    }
  }
  if (high.x < 0) { // missed so far
    return {glm::ivec2(0), glm::ivec2(view.width, view.height)};
  }
  return {glm::max(low, glm::ivec2(0)), glm::min(high + 1, glm::ivec2(view.width, view.height))};
}

void LookAhead::send(const View& view, const Scene& scene, const Arena& arena)
{
  Clear(this->Allowed, this->Cells);
  Clear(this->Needs, this->Blocks);
  const auto [low, high] = seenPart(view); // where that is small, rays are closer
  const PixelGrid seen(low, high - low, RaysAcross);
  arena.forEachBlock(seen.count(), RaysPerTask, [&](std::int64_t begin, std::int64_t end) {
    Walk walk;
    for (std::int64_t k = begin; k < end; ++k) {
      const glm::ivec2 pixel = seen.pixel(k);
      const Ray ray = view.geometry.ray(pixel.x, pixel.y);
      if (ray.length > 0) {
        this->follow(ray, scene, walk);
      }
    }
  });
}

void LookAhead::follow(const Ray& ray, const Scene& scene, Walk& walk)
{
  walk.start();
  CellWalker cells(scene.majorants.view(), scene.dims, ray, 0.0, 1);
  cells.moveTo(0);
  const double stepsPerVoxel = 1.0 / (scene.step * glm::length(ray.direction));
  double light = 1.0; // of what is here, that is seen
  for (double t = 0; t < ray.length && light > Hidden && cells.moveToVisible(ray.length);) {
    const std::int64_t cell = cells.index();
    const double exit = std::min(cells.exit(), ray.length);
    const double steps = (exit - std::max(t, cells.enter())) / scene.step;
    // Rays beside this one may go all through a cell of which it meets a corner.
    const double crossing = std::max(steps, stepsPerVoxel * scene.errors.longestEdge());
    walk.add(cell, scene.errors.of(cell), this->Allowable, stepsPerVoxel, crossing, light);
    if (scene.errors.canMatter(cell)) {
      Raise(this->Needs[static_cast<std::size_t>(scene.measured.blockOf(cell))],
            scene.measured.knows(cell, scene.question) ? Seen : NotKnown);
    }
    light *= std::exp(-steps * scene.errors.opticalDepth(cell));
    t = exit;
    if (t < ray.length) {
      cells.moveTo(t);
    }
  }
  const int number = walk.firstWithin(this->Tolerance);
  for (const std::int64_t cell : walk.cells) {
    Raise(this->Allowed[static_cast<std::size_t>(cell)], number + 1);
  }
}

std::vector<std::int64_t> LookAhead::blocksWith(Need need) const
{
  std::vector<std::int64_t> blocks;
  for (std::int64_t block = 0; block < this->Blocks; ++block) {
    if (this->Needs[static_cast<std::size_t>(block)] >= need) {
      blocks.push_back(block);
    }
  }
  return blocks;
}

} // namespace inr
