// SPDX-License-Identifier: BSD-3-Clause
//
// The walk through macro-cells against stepping densely along the ray.
#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Core/Render/MacroCells/GridWalker.h"
#include "Core/Render/MacroCells/MajorantGrid.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace test::grid_walker {

struct Cells
{
  glm::dvec3 dims;
  inr::MajorantGrid majorants;
};

/// Cells of a volume of `dims` voxels, as our files and upstream's have them; one in `rarity`
/// visible.
Cells MakeCells(const glm::i64vec3& dims, const glm::dvec3& spacing, std::uint64_t rarity = 4)
{
  inr::MacroCells cells;
  cells.spacing = spacing;
  cells.dims = glm::i64vec3(glm::ceil(1.0 / spacing));
  cells.ranges.resize(static_cast<std::size_t>(cells.dims.x * cells.dims.y * cells.dims.z));
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
    const float value = inr::RandomBits(11, k) % rarity == 0 ? 0.9f : 0.1f;
    cells.ranges[k] = {value, value};
  }
  inr::TransferFunction function;
  function.table = {{0, 0, 0, 0}, {0, 0, 0, 0}, {1, 1, 1, 0.5f}};
  inr::MajorantGrid majorants(cells);
  majorants.update(inr::ColorTable(function, inr::VolumeInfo{}), inr::Arena(1));
  return {glm::dvec3(dims), std::move(majorants)};
}

inr::Ray MakeRay(const glm::dvec3& entry, const glm::dvec3& direction, double length)
{
  inr::Ray ray;
  ray.entry = entry;
  ray.direction = direction;
  ray.inverse = 1.0 / direction;
  ray.length = length;
  return ray;
}

/// Rays of all kinds: slanted, along axes, along cell faces, through cell corners.
std::vector<inr::Ray> Rays(const Cells& cells)
{
  std::vector<inr::Ray> rays;
  const double reach = glm::length(cells.dims);
  const auto random = [](std::uint64_t k) { return 2.0 * inr::RandomUnit(5, k) - 1.0; };
  for (std::uint64_t k = 0; k < 60; ++k) {
    const glm::dvec3 through =
        cells.dims * glm::dvec3(inr::RandomUnit(6, 3 * k), //
                                inr::RandomUnit(6, 3 * k + 1), inr::RandomUnit(6, 3 * k + 2));
    const glm::dvec3 way =
        glm::normalize(glm::dvec3(random(3 * k), random(3 * k + 1), random(3 * k + 2)));
    rays.push_back(MakeRay(through - 0.5 * reach * way, way, reach));
  }
  const glm::dvec3 edge = cells.majorants.spacing() * cells.dims;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 way(0.0);
      way[axis] = sign;
      glm::dvec3 onFaces = edge - 0.5; // between cells 0 and 1 along the other two axes
      onFaces[axis] = sign > 0 ? 0.0 : cells.dims[axis] - 1;
      rays.push_back(MakeRay(onFaces, way, cells.dims[axis] - 1));
    }
  }
  rays.push_back(MakeRay(glm::dvec3(-0.5), glm::normalize(edge), reach)); // through corners
  return rays;
}

std::int64_t CellAt(const Cells& cells, const inr::Ray& ray, double t)
{
  const glm::dvec3 u = (ray.at(t) + 0.5) / cells.dims / cells.majorants.spacing();
  const glm::i64vec3 last = cells.majorants.dims() - std::int64_t{1};
  return cells.majorants.index(glm::clamp(glm::i64vec3(glm::floor(u)), glm::i64vec3(0), last));
}

std::vector<Cells> AllCells()
{
  std::vector<Cells> all;
  all.push_back(MakeCells({61, 47, 80}, glm::dvec3(16.0) / glm::dvec3(61, 47, 80)));
  all.push_back(MakeCells({61, 47, 80}, {0.13, 0.21, 0.0501})); // not of whole voxels
  all.push_back(MakeCells({40, 40, 1}, {0.4, 0.4, 1.0}));
  all.push_back(MakeCells({100000, 9, 9}, {0.00016, 1, 1}));
  return all;
}

TEST(GridWalker, IsWhereItShouldBe)
{
  for (const Cells& cells : AllCells()) {
    for (const inr::Ray& ray : Rays(cells)) {
      inr::GridWalker walker(cells.majorants.view(), cells.dims, ray);
      const double step = ray.length / 997;
      for (int k = 0; k < 997; ++k) {
        const double t = k * step;
        walker.moveTo(t);
        ASSERT_LT(t, walker.exit());
        ASSERT_GE(t, walker.enter());
        const double inside = 1e-7 * ray.length; // next to a face both cells are right
        if (t - walker.enter() > inside && walker.exit() - t > inside) {
          const std::int64_t cell = CellAt(cells, ray, t);
          ASSERT_EQ(walker.extinction(), cells.majorants.extinction(cell));
        }
      }
    }
  }
}

TEST(GridWalker, StartsAnywhereWithTheSameCell)
{
  for (const Cells& cells : AllCells()) {
    for (const inr::Ray& ray : Rays(cells)) {
      inr::GridWalker steady(cells.majorants.view(), cells.dims, ray);
      for (int k = 0; k < 300; ++k) {
        const double t = k * ray.length / 300;
        inr::GridWalker fresh(cells.majorants.view(), cells.dims, ray);
        steady.moveTo(t);
        fresh.moveTo(t);
        ASSERT_EQ(fresh.enter(), steady.enter());
        ASSERT_EQ(fresh.exit(), steady.exit());
      }
    }
  }
}

TEST(GridWalker, FollowsAnotherRayAsIfItHadNeverGoneElsewhere)
{
  for (const Cells& cells : AllCells()) {
    inr::GridWalker used;
    for (const inr::Ray& ray : Rays(cells)) {
      used.follow(ray, cells.majorants.view(),
                  inr::MakeCellScale(cells.majorants.view(), cells.dims));
      inr::GridWalker fresh(cells.majorants.view(), cells.dims, ray);
      for (const double part : {0.3, 0.6}) {
        used.moveTo(part * ray.length);
        fresh.moveTo(part * ray.length);
        ASSERT_EQ(used.cell(), fresh.cell());
        ASSERT_EQ(used.enter(), fresh.enter());
        ASSERT_EQ(used.exit(), fresh.exit());
      }
    }
  }
}

TEST(GridWalker, SkipsNothingThatCanBeSeen)
{
  for (const Cells& cells : AllCells()) {
    for (const inr::Ray& ray : Rays(cells)) {
      inr::GridWalker walker(cells.majorants.view(), cells.dims, ray);
      walker.moveTo(0);
      double t = 0;
      while (t < ray.length) {
        const double from = t;
        const bool seen = walker.moveToVisible(ray.length);
        const double until = seen ? std::max(walker.enter(), from) : ray.length;
        for (int k = 1; k < 50; ++k) { // what was skipped is empty
          const double at = from + (until - from) * k / 50;
          const double inside = 1e-7 * ray.length;
          if (at - from > inside && until - at > inside &&
              CellAt(cells, ray, at - inside) == CellAt(cells, ray, at + inside)) {
            ASSERT_EQ(cells.majorants.extinction(CellAt(cells, ray, at)), 0.0f);
          }
        }
        if (!seen || walker.exit() >= ray.length) {
          break;
        }
        t = walker.exit();
        walker.moveTo(t);
      }
    }
  }
}

struct Stretch
{
  double enter;
  double exit;
  bool operator==(const Stretch& other) const
  {
    return this->enter == other.enter && this->exit == other.exit;
  }
};

/// The visible cells of a ray, found by stopping in every cell.
std::vector<Stretch> SeenCellByCell(const Cells& cells, const inr::Ray& ray, double from)
{
  std::vector<Stretch> seen;
  inr::GridWalker walker(cells.majorants.view(), cells.dims, ray);
  for (double t = from; t < ray.length; t = walker.exit()) {
    walker.moveTo(t);
    if (walker.extinction() > 0.0f) {
      seen.push_back({walker.enter(), walker.exit()});
    }
  }
  return seen;
}

/// The same, found by leaving empty blocks at once.
std::vector<Stretch> SeenWithLeaps(const Cells& cells, const inr::Ray& ray, double from)
{
  std::vector<Stretch> seen;
  inr::GridWalker walker(cells.majorants.view(), cells.dims, ray);
  walker.moveTo(from);
  while (walker.moveToVisible(ray.length)) {
    if (walker.exit() > walker.enter()) { // not just a corner
      seen.push_back({walker.enter(), walker.exit()});
    }
    if (walker.exit() >= ray.length) {
      break;
    }
    walker.moveTo(walker.exit());
  }
  return seen;
}

TEST(GridWalker, LeapsToTheVeryCellsThatStepsComeTo)
{
  std::size_t seen = 0;
  for (const std::uint64_t rarity : {20, 300, 4000, 1000000}) {
    for (const glm::dvec3& spacing :
         {glm::dvec3(1.0 / 64), glm::dvec3(0.0131, 0.021, 0.0501), glm::dvec3(1, 0.01, 0.003)}) {
      const Cells cells = MakeCells({256, 200, 300}, spacing, rarity);
      for (const inr::Ray& ray : Rays(cells)) {
        for (const double from : {0.0, 0.4 * ray.length}) {
          const std::vector<Stretch> leaps = SeenWithLeaps(cells, ray, from);
          ASSERT_EQ(leaps, SeenCellByCell(cells, ray, from));
          seen += leaps.size();
        }
      }
    }
  }
  EXPECT_GT(seen, 1000u);
}

} // namespace test::grid_walker
