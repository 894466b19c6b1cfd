// SPDX-License-Identifier: BSD-3-Clause
//
// What majorants say of samples of every level, against all that these samples can be made of.
#include "Core/Cache/BrickSource.h"
#include "Core/Error.h"
#include "Core/Model/ScaledModel.h"
#include "Core/Render/MacroCells/CellWalker.h"
#include "Core/Render/MacroCells/Majorants.h"
#include "Core/Render/Rays/LevelOfDetail.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test::majorants {

float RandomAt(const glm::vec3& place)
{
  const glm::i64vec3 at(glm::floor(place));
  return static_cast<float>(
      inr::RandomUnit(1, static_cast<std::uint64_t>(at.x + 1000 * (at.y + 1000 * at.z))));
}

/// Blocks that have nothing in common with their neighbours.
float Blocks(const glm::vec3& u) { return RandomAt(u * 8.7f); }

/// The same with a little noise in each.
float Noise(const glm::vec3& u) { return 0.9f * Blocks(u) + 0.1f * RandomAt(u * 301.0f); }

/// A volume's voxels at all levels, and macro-cells that hold what the network says within them and
/// some voxels around, no more.
struct Volume
{
  Volume(const glm::i64vec3& size, const inr::MacroCells& empty, float (*truth)(const glm::vec3&),
         double apron = 1)
      : dims(size), hierarchy(size, 8), cells(empty), Truth(truth)
  {
    this->cells.apron = apron / glm::dvec3(size);
    const auto field = std::make_shared<FieldEvaluator>([this](const glm::vec3& u) {
      this->extend(u);
      return this->Truth(u);
    });
    const auto source = inr::MakeBrickSource(field, this->hierarchy);
    for (int level = 0; level < this->hierarchy.levels(); ++level) {
      this->levels.push_back(this->decode(*source, level));
    }
  }

  /// Trilinear, at a point of the unit cube.
  float at(int level, const glm::dvec3& u) const
  {
    const glm::i64vec3& size = this->hierarchy.size(level);
    const glm::dvec3 last(size - std::int64_t{1});
    const glm::dvec3 place = glm::clamp(u * glm::dvec3(size) - 0.5, glm::dvec3(0.0), last);
    const glm::dvec3 cell = glm::floor(place);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 near = 1.0 - glm::abs(place - cell - step);
      const glm::i64vec3 v(glm::min(cell + step, last));
      const auto index = static_cast<std::size_t>(v.x + size.x * (v.y + size.y * v.z));
      sum += near.x * near.y * near.z * this->levels[static_cast<std::size_t>(level)][index];
    }
    return static_cast<float>(sum);
  }

  glm::i64vec3 cellAt(const inr::MajorantGrid& grid, const glm::dvec3& u) const
  {
    const glm::i64vec3 at(glm::floor(u / grid.spacing()));
    return glm::clamp(at, glm::i64vec3(0), grid.dims() - std::int64_t{1});
  }

  glm::i64vec3 dims;
  inr::Hierarchy hierarchy;
  inr::MacroCells cells;
  std::vector<std::vector<float>> levels;

private:
  void extend(const glm::vec3& u)
  {
    const glm::dvec3 apron = 1.001 * this->cells.apron;
    const glm::i64vec3 last = this->cells.dims - std::int64_t{1};
    const glm::i64vec3 low((glm::dvec3(u) - apron) / this->cells.spacing);
    const glm::i64vec3 high((glm::dvec3(u) + apron) / this->cells.spacing);
    for (std::int64_t z = glm::max(low.z, std::int64_t{0}); z <= glm::min(high.z, last.z); ++z) {
      for (std::int64_t y = glm::max(low.y, std::int64_t{0}); y <= glm::min(high.y, last.y); ++y) {
        for (std::int64_t x = glm::max(low.x, std::int64_t{0}); x <= glm::min(high.x, last.x);
             ++x) {
          this->cells.ranges[static_cast<std::size_t>(this->cells.index(x, y, z))].extend(
              this->Truth(u));
        }
      }
    }
  }

  std::vector<float> decode(const inr::BrickSource& source, int level) const
  {
    const glm::i64vec3& size = this->hierarchy.size(level);
    const glm::i64vec3& bricks = this->hierarchy.bricks(level);
    const glm::i64vec3 brick(this->hierarchy.brickDims());
    std::vector<float> voxels(static_cast<std::size_t>(size.x * size.y * size.z));
    std::vector<float> values(static_cast<std::size_t>(this->hierarchy.voxelsPerBrick()));
    for (std::int64_t k = 0; k < bricks.x * bricks.y * bricks.z; ++k) {
      const inr::BrickId id{level,
                            {k % bricks.x, k / bricks.x % bricks.y, k / (bricks.x * bricks.y)}};
      const inr::BrickKey key = inr::KeyOf(id);
      source.infer(&key, 1, values.data(), inr::Arena(1));
      const glm::i64vec3 first = this->hierarchy.firstVoxel(id);
      for (std::int64_t i = 0; i < this->hierarchy.voxelsPerBrick(); ++i) {
        const glm::i64vec3 v =
            first + glm::i64vec3(i % brick.x, i / brick.x % brick.y, i / (brick.x * brick.y));
        if (v.x < size.x && v.y < size.y && v.z < size.z) {
          voxels[static_cast<std::size_t>(v.x + size.x * (v.y + size.y * v.z))] =
              values[static_cast<std::size_t>(i)];
        }
      }
    }
    return voxels;
  }

  float (*Truth)(const glm::vec3&);
};

inr::MacroCells LikeUpstream(const glm::dvec3& spacing)
{
  inr::MacroCells cells;
  cells.spacing = spacing;
  cells.dims = glm::i64vec3(glm::ceil(1.0 / spacing));
  cells.ranges.resize(static_cast<std::size_t>(cells.dims.x * cells.dims.y * cells.dims.z));
  return cells;
}

std::vector<Volume> Volumes(float (*truth)(const glm::vec3&) = Noise)
{
  const glm::i64vec3 odd(75, 50, 33);
  const glm::i64vec3 slab(90, 1, 61);
  return {{odd, inr::MakeMacroCells(odd, 16), truth},
          {odd, inr::MakeMacroCells(odd, 4), truth},
          {odd, inr::MakeMacroCells(odd, 16), truth, 2.6},
          {odd, inr::MakeMacroCells(odd, 8), truth, 5.1},
          {odd, LikeUpstream({0.07, 0.11, 0.3}), truth},
          {odd, LikeUpstream({0.019, 0.02, 1}), truth}, // cells of less than two voxels
          {slab, inr::MakeMacroCells(slab, 8), truth}};
}

/// Points at random and the corners of the cube's voxels.
glm::dvec3 PointOf(const Volume& volume, std::uint64_t number)
{
  glm::dvec3 u;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 / static_cast<double>(volume.dims[axis]);
    const double random = inr::RandomUnit(5, 3 * number + static_cast<std::uint64_t>(axis));
    u[axis] = glm::clamp(1.1 * random - 0.05, half, 1.0 - half);
  }
  return u;
}

bool Holds(const inr::ValueRange& range, float value)
{
  constexpr float rounding = 1e-6f;
  return value >= range.low - rounding && value <= range.high + rounding;
}

TEST(Majorants, HaveFiniteRanges)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinite = std::numeric_limits<float>::infinity();
  for (const inr::ValueRange range :
       {inr::ValueRange{nan, 1}, {0, nan}, {-infinite, 1}, {0, infinite}}) {
    inr::MacroCells cells = inr::MakeMacroCells(glm::i64vec3(64), 16);
    cells.ranges[7] = range;
    EXPECT_THROW(inr::Majorants{cells}, inr::Error) << range.low << " " << range.high;
  }
}

TEST(Majorants, BoundSamplesOfEveryLevel)
{
  int beyondTheirCell = 0;
  for (const Volume& volume : Volumes()) {
    const inr::Majorants majorants(volume.cells, volume.dims, inr::Arena(2));
    for (int level = 0; level < volume.hierarchy.levels(); ++level) {
      for (std::uint64_t k = 0; k < 20000; ++k) {
        const glm::dvec3 u = PointOf(volume, k);
        const float value = volume.at(level, u);
        const inr::MajorantGrid& own = majorants.grid(0);
        beyondTheirCell += Holds(own.range(own.index(volume.cellAt(own, u))), value) ? 0 : 1;
        for (int grid = 0; grid < majorants.grids(); ++grid) {
          if (level <= majorants.coarsestLevel(grid)) {
            const inr::MajorantGrid& cells = majorants.grid(grid);
            ASSERT_TRUE(Holds(cells.range(cells.index(volume.cellAt(cells, u))), value))
                << "level " << level << " grid " << grid;
          }
        }
      }
    }
  }
  EXPECT_GT(beyondTheirCell, 1000); // else this would be no test
}

inr::TransferFunction RandomFunction(std::uint64_t stream)
{
  inr::TransferFunction function;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const double opacity =
        inr::RandomUnit(stream, 2 * k) < 0.8 ? 0 : 0.9 * inr::RandomUnit(stream, 2 * k + 1);
    function.table.push_back({1, 1, 1, static_cast<float>(opacity)});
  }
  return function;
}

TEST(Majorants, BoundWhatSamplesOfEveryLevelShow)
{
  for (const Volume& volume : Volumes()) {
    inr::Majorants majorants(volume.cells, volume.dims, inr::Arena(2));
    for (std::uint64_t stream = 0; stream < 4; ++stream) {
      const inr::ColorTable colors(RandomFunction(stream), inr::VolumeInfo{});
      majorants.update(colors, inr::Arena(2));
      for (int grid = 0; grid < majorants.grids(); ++grid) {
        const inr::MajorantGrid& cells = majorants.grid(grid);
        const int last = std::min(majorants.coarsestLevel(grid), volume.hierarchy.levels() - 1);
        for (std::uint64_t k = 0; k < 5000; ++k) {
          const glm::dvec3 u = PointOf(volume, k);
          const float value = volume.at(static_cast<int>(k % (last + 1)), u);
          const float shown = -std::log1p(-colors.lookup().at(value).w);
          ASSERT_LE(shown, cells.extinction(cells.index(volume.cellAt(cells, u))) + 1e-4f);
        }
      }
    }
  }
}

TEST(Majorants, GoByTheCellsAloneAsFarAsTheirApronReaches)
{
  const glm::i64vec3 dims(75, 50, 33);
  for (const auto& [apron, coarsest] : {std::pair(0.0, 0), {2.4, 0}, {2.6, 1}, {5.1, 2}}) {
    inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
    std::fill(cells.ranges.begin(), cells.ranges.end(), inr::ValueRange{0, 1});
    cells.apron = apron / glm::dvec3(dims);
    EXPECT_EQ(inr::Majorants(cells, dims, inr::Arena(1)).coarsestLevel(0), coarsest) << apron;
  }
}

TEST(Majorants, AreOfUseAtCoarseLevels)
{
  inr::MacroCells cells = inr::MakeMacroCells(glm::i64vec3(512), 16);
  for (inr::ValueRange& range : cells.ranges) {
    range = {0, 0};
  }
  cells.ranges[static_cast<std::size_t>(cells.index(9, 9, 9))] = {0, 1};
  inr::Majorants majorants(cells, glm::i64vec3(512), inr::Arena(1));
  majorants.update(inr::ColorTable(OpacityRamp(0.5f), inr::VolumeInfo{}), inr::Arena(1));
  EXPECT_EQ(majorants.coarsestLevel(0), 0);
  EXPECT_EQ(majorants.coarsestLevel(1), 3); // 10 voxels on either side of 16
  for (int grid = 1; grid < majorants.grids(); ++grid) {
    const inr::MajorantGrid& coarse = majorants.grid(grid);
    int visible = 0;
    for (std::int64_t k = 0; k < coarse.dims().x * coarse.dims().y * coarse.dims().z; ++k) {
      visible += coarse.extinction(k) > 0 ? 1 : 0;
    }
    EXPECT_LE(visible, 27);
    EXPECT_EQ(coarse.extinction(coarse.index(glm::i64vec3(9) >> std::int64_t{grid - 1})),
              majorants.grid(0).extinction(majorants.grid(0).index({9, 9, 9})));
  }
}

/// A ray into the volume, growing wider.
inr::Ray RayInto(const Volume& volume, std::uint64_t number)
{
  const glm::dvec3 dims(volume.dims);
  inr::Ray ray;
  ray.entry = (PointOf(volume, number) * dims - 0.5) * glm::dvec3(0, 1, 1);
  ray.direction =
      glm::normalize(PointOf(volume, number + 1000) * glm::dvec3(1, 2, 2) - glm::dvec3(-0.1, 1, 1));
  ray.inverse = 1.0 / ray.direction;
  ray.length = 0.6 * dims.x;
  ray.footprint = 2 * inr::RandomUnit(6, number);
  ray.footprintGrowth = 0.3 * inr::RandomUnit(7, number);
  return ray;
}

/// What the ray stops at bounds the levels that are sampled there; what it skips cannot be seen at
/// them.
void CheckWalk(const Volume& volume, const inr::Majorants& majorants, const inr::ColorTable& colors,
               const inr::Ray& ray)
{
  const glm::dvec3 dims(volume.dims);
  const int levels = volume.hierarchy.levels();
  inr::CellWalker walker(majorants.view(), dims, ray, 1.0, levels);
  inr::LevelOfDetail detail(ray, 1.0, levels);
  double skippedTo = 0;
  for (double t = 0; t < ray.length; t += 0.37) {
    if (t >= skippedTo) {
      walker.moveTo(t);
      ASSERT_LT(t, walker.exit());
      const bool seen = walker.extinction() > 0;
      skippedTo = seen ? t : walker.moveToVisible(ray.length) ? walker.enter() : ray.length;
    }
    const bool skipped = t < skippedTo;
    if (!skipped) {
      inr::CellWalker fresh(majorants.view(), dims, ray, 1.0, levels);
      fresh.moveTo(t);
      ASSERT_EQ(&fresh.range(), &walker.range());
    }
    detail.moveTo(t);
    const glm::dvec3 u = (glm::clamp(ray.at(t), glm::dvec3(0), dims - 1.0) + 0.5) / dims;
    for (const int level : {detail.level(), detail.coarsest()}) {
      const float value = volume.at(level, u);
      if (!skipped) {
        ASSERT_TRUE(Holds(walker.range(), value)) << "level " << level;
      } else {
        ASSERT_EQ(colors.lookup().at(value).w, 0.0f) << "level " << level;
      }
    }
  }
}

TEST(CellWalker, GoesByTheLevelThatIsSampled)
{
  inr::TransferFunction function;
  function.table.assign(100, glm::vec4(0));
  std::fill_n(function.table.begin() + 70, 30, glm::vec4(1, 1, 1, 0.5f));
  const inr::ColorTable colors(function, inr::VolumeInfo{});
  for (const Volume& volume : Volumes()) {
    inr::Majorants majorants(volume.cells, volume.dims, inr::Arena(1));
    majorants.update(colors, inr::Arena(1));
    for (std::uint64_t number = 0; number < 500; ++number) {
      CheckWalk(volume, majorants, colors, RayInto(volume, number));
    }
  }
}

/// Pictures of every coarseness, complete or on the way there, with nothing but what is there.
TEST(Majorants, ClampNoSampleForBeingCoarse)
{
  for (const Volume& volume : Volumes()) {
    for (const double scale : {0.0, 1.5, 7.0, 30.0}) {
      inr::Renderer renderer = FieldRenderer(volume.dims, Noise, volume.cells, 2, true);
      renderer.setTransferFunction(OpacityRamp(0.01f));
      inr::Frame frame = ParallelFrame(64, {0, -1}, {volume.dims.x, volume.dims.y}, -10, 100);
      frame.levelOfDetailScale = scale;
      frame.adaptiveSampling = false;
      inr::Image image;
      for (const double limit : {1e-9, 1e-9, 0.0}) {
        frame.timeLimit = limit;
        const inr::FrameStatistics statistics = renderer.render(frame, image);
        EXPECT_GT(statistics.samples, 0);
        EXPECT_EQ(statistics.clamped, 0) << "scale " << scale;
      }
    }
  }
}

/// The same of volumes with fewer or more voxels than the cells were made for.
TEST(Majorants, ClampNoSampleOfAScaledVolume)
{
  for (const Volume& volume : Volumes(Blocks)) {
    auto model = std::make_shared<inr::Model>();
    model->volume.dims = volume.dims;
    model->macroCells = volume.cells;
    for (const double factor : {0.25, 0.6, 1.0, 2.5}) {
      const inr::ModelPointer scaled = inr::ScaledModel(model, factor);
      const glm::i64vec3& dims = scaled->volume.dims;
      inr::Renderer renderer = FieldRenderer(dims, Blocks, scaled->macroCells, 2, true);
      renderer.setTransferFunction(OpacityRamp(0.01f));
      inr::Frame frame = ParallelFrame(64, {0, -1}, {dims.x, dims.y}, -10, 200);
      for (const double scale : {0.0, 2.0}) {
        frame.levelOfDetailScale = scale;
        inr::Image image;
        const inr::FrameStatistics statistics = renderer.render(frame, image);
        EXPECT_GT(statistics.samples, 0);
        EXPECT_EQ(statistics.clamped, 0) << "factor " << factor << " scale " << scale;
      }
    }
  }
}

} // namespace test::majorants
