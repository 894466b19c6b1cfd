// SPDX-License-Identifier: BSD-3-Clause
//
// Where samples are, against what the macro-cells and the levels of detail say point by point.
#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Core/Render/MacroCells/Majorants.h"
#include "Core/Render/Marching/SampleWalker.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace test::sample_walker {

constexpr int Levels = 6;
const glm::i64vec3 VolumeDims(150, 90, 120);

/// Half of the cells cannot be seen, the others are faint or not.
inr::Majorants MakeMajorants()
{
  inr::MacroCells cells = inr::MakeMacroCells(VolumeDims, 16);
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
    const std::uint64_t kind = inr::RandomBits(11, k) % 6;
    const float value = kind < 3 ? 0.1f : kind == 3 ? 0.5f : kind == 4 ? 0.6f : 0.9f;
    cells.ranges[k] = {value, value};
  }
  inr::TransferFunction function;
  for (const float opacity : {0.0f, 0.0f, 0.0f, 0.0f, 0.008f, 0.015f, 0.02f, 0.5f, 0.5f}) {
    function.table.emplace_back(1, 1, 1, opacity);
  }
  inr::Majorants majorants(cells, VolumeDims, inr::Arena(1));
  majorants.update(inr::ColorTable(function, inr::VolumeInfo{}), inr::Arena(1));
  return majorants;
}

inr::Ray RandomRay(std::uint64_t number)
{
  const auto random = [&](std::uint64_t k) {
    return 2.0 * inr::RandomUnit(7, 10 * number + k) - 1;
  };
  const glm::dvec3 dims(VolumeDims);
  inr::Ray ray;
  ray.direction = glm::normalize(glm::dvec3(random(0), random(1), random(2)));
  ray.entry =
      dims * (0.5 + 0.3 * glm::dvec3(random(3), random(4), random(5))) - 60.0 * ray.direction;
  ray.inverse = 1.0 / ray.direction;
  ray.length = 120.0 + 5.0 * random(6);
  ray.footprint = 1.5 + 1.4 * random(7);
  ray.footprintGrowth = 0.02 * (1 + random(8));
  return ray;
}

struct Sample
{
  std::int64_t interval;
  std::int64_t steps;
  double place;
  float low; ///< of its range

  bool operator==(const Sample& other) const
  {
    return this->interval == other.interval && this->steps == other.steps &&
           this->place == other.place && this->low == other.low;
  }
};

inr::SampleWalker WalkerOn(const inr::Ray& ray, const inr::Majorants& majorants,
                           const inr::MarchSettings& settings, double jitter)
{
  const double scale = settings.cellSampling != nullptr ? 0.0 : 1.0; // one of them says levels
  return {majorants.view(), settings, ray, scale, Levels, jitter};
}

/// All samples of a ray, taken `most` at a time.
std::vector<Sample> Walk(inr::SampleWalker walker, const inr::MarchSettings& settings, int most)
{
  std::vector<Sample> samples;
  while (walker.moveToVisible(settings)) {
    const inr::AlikeSamples alike = walker.alike();
    EXPECT_GE(alike.count, 1);
    const int count = std::min(most, alike.count);
    for (int k = 0; k < count; ++k) {
      const std::int64_t interval = walker.next() + k * alike.steps();
      samples.push_back({interval, alike.steps(),
                         static_cast<double>(interval) + walker.offset(alike),
                         walker.stretch().range.low});
    }
    walker.pass(alike, count);
  }
  return samples;
}

inr::MarchSettings Settings()
{
  inr::MarchSettings settings;
  settings.dims = glm::dvec3(VolumeDims);
  settings.step = 0.5;
  return settings;
}

/// What each macro-cell asks for: at random, alike in two neighbours of three.
std::vector<inr::CellSampling> RandomSampling(const inr::Majorants& majorants)
{
  std::vector<inr::CellSampling> sampling(static_cast<std::size_t>(majorants.grid(0).count()));
  for (std::size_t k = 0; k < sampling.size(); ++k) {
    const auto power = static_cast<std::uint8_t>(inr::RandomBits(12, k / 3) % 4);
    const bool coarser = inr::RandomBits(13, k / 3) % 2 == 0;
    sampling[k] = {coarser ? power : std::uint8_t{0}, power};
  }
  return sampling;
}

/// Whether cells say where samples come from.
class SampleWalkers : public testing::TestWithParam<bool>
{
protected:
  const inr::Majorants Cells = MakeMajorants();
  const std::vector<inr::CellSampling> Sampling = RandomSampling(this->Cells);

  inr::MarchSettings settings() const
  {
    inr::MarchSettings settings = Settings();
    settings.cellSampling = GetParam() ? this->Sampling.data() : nullptr;
    return settings;
  }
};

INSTANTIATE_TEST_SUITE_P(, SampleWalkers, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "AsCellsSay" : "ByDistance");
});

TEST_P(SampleWalkers, StopWherePleasesWithoutChange)
{
  const inr::Majorants& majorants = this->Cells;
  const inr::MarchSettings settings = this->settings();
  for (std::uint64_t number = 0; number < 200; ++number) {
    const inr::Ray ray = RandomRay(number);
    const inr::SampleWalker walker = WalkerOn(ray, majorants, settings, inr::RandomUnit(8, number));
    const std::vector<Sample> all = Walk(walker, settings, 1000);
    EXPECT_EQ(Walk(walker, settings, 1), all) << number;
    EXPECT_EQ(Walk(walker, settings, 3), all) << number;
  }
}

TEST_P(SampleWalkers, ResumeFromWhereTheyOnceWere)
{
  const inr::Majorants& majorants = this->Cells;
  const inr::MarchSettings settings = this->settings();
  for (std::uint64_t number = 0; number < 100; ++number) {
    const inr::SampleWalker before =
        WalkerOn(RandomRay(number), majorants, settings, inr::RandomUnit(8, number));
    const std::vector<Sample> all = Walk(before, settings, 1000);
    inr::SampleWalker walker = before;
    for (std::size_t passed = 0; walker.moveToVisible(settings); ++passed) {
      inr::SampleWalker resumed = before;
      resumed.resume(walker.next(), walker.stretch(), settings);
      const std::vector<Sample> rest(all.begin() + static_cast<std::ptrdiff_t>(passed), all.end());
      ASSERT_EQ(Walk(resumed, settings, 1000), rest) << number;
      walker.pass(walker.alike(), 1);
    }
  }
}

/// From some place in front of all visible cells of a ray to some place behind them.
inr::SeenSpan SpanOf(const inr::Ray& ray, const inr::Majorants& majorants,
                     const inr::MarchSettings& settings, std::uint64_t number)
{
  const double scale = settings.cellSampling != nullptr ? 0.0 : 1.0;
  inr::CellWalker cells(majorants.view(), settings.dims, ray, scale, Levels);
  inr::SeenSpan seen{inr::Infinite, -inr::Infinite};
  for (double t = 0; t < ray.length; t = cells.exit()) {
    cells.moveTo(t);
    if (cells.extinction() > 0) {
      const double share = number % 2 == 0 ? inr::RandomUnit(14, number) : 0.99;
      seen.begin = std::min(seen.begin, cells.enter() * share);
      seen.end = cells.exit() + 30 * inr::RandomUnit(15, number);
    }
  }
  return seen;
}

/// Pieces share the samples of surfaces that stand for steps in both.
TEST_P(SampleWalkers, TakeTheSameWhereTheyAreConfinedToWhatIsSeen)
{
  int empty = 0;
  for (std::uint64_t number = 0; number < 2000; ++number) {
    inr::MarchSettings settings = this->settings();
    settings.projector.mode =
        number % 3 == 0 ? inr::BlendMode::Isosurface : inr::BlendMode::Composite;
    inr::Ray ray = RandomRay(number);
    ray.length *= number % 4 == 0 ? 0.1 : 1.0;
    ray.pieceEnd = number % 7 == 0 ? inr::Infinite : ray.length * inr::RandomUnit(16, number);
    if (number % 7 == 3) { // right in front of the first cell that is seen
      const double begin = SpanOf(ray, this->Cells, settings, number).begin;
      ray.pieceEnd = std::min(ray.length, begin);
    }
    ray.pieceBegin = number % 2 == 0 ? 0.0 : 0.5 * std::min(ray.length, ray.pieceEnd);
    const double jitter = number % 5 == 0 ? 1.0 : inr::RandomUnit(8, number);
    const inr::SampleWalker walker = WalkerOn(ray, this->Cells, settings, jitter);
    const inr::SeenSpan seen = SpanOf(ray, this->Cells, settings, number);
    empty += seen.empty() ? 1 : 0;
    inr::SampleWalker confined = walker;
    confined.confine(seen, settings);
    ASSERT_TRUE(Walk(confined, settings, 1000) == Walk(walker, settings, 1000)) << number;
  }
  EXPECT_GT(empty, 30);
  EXPECT_LT(empty, 600);
}

/// What the macro-cells say at t: whether it can be seen, and how deep a sample of `steps` is.
struct CellAt
{
  bool visible;
  double depth;
};

CellAt LookAt(const inr::Ray& ray, const inr::Majorants& majorants,
              const inr::MarchSettings& settings, double t, std::int64_t steps)
{
  inr::CellWalker cells(majorants.view(), settings.dims, ray, 1.0, Levels);
  cells.moveTo(t);
  return {cells.extinction() > 0,
          cells.extinction() * settings.step * static_cast<double>(steps) * settings.unitsPerT};
}

TEST(SampleWalker, TakesWhatCanBeSeenAndNothingTwice)
{
  const inr::Majorants majorants = MakeMajorants();
  const inr::MarchSettings settings = Settings();
  int joined = 0;
  for (std::uint64_t number = 0; number < 200; ++number) {
    const inr::Ray ray = RandomRay(number);
    const double jitter = inr::RandomUnit(8, number);
    inr::LevelOfDetail detail(ray, 1.0, Levels);
    std::int64_t end = 0; // of what the samples before stood for
    for (const Sample& sample : Walk(WalkerOn(ray, majorants, settings, jitter), settings, 1000)) {
      EXPECT_GE(sample.interval, end);
      // What was left out cannot be seen where its own samples would have been.
      for (std::int64_t k = end; k < sample.interval; ++k) {
        detail.moveTo(static_cast<double>(k) * settings.step);
        const std::int64_t level = std::int64_t{1} << detail.coarsest();
        if (k % level == 0 && k + level <= sample.interval) {
          const double t =
              (static_cast<double>(k) + jitter * static_cast<double>(level)) * settings.step;
          EXPECT_FALSE(LookAt(ray, majorants, settings, t, 1).visible) << number << " " << k;
        }
      }
      detail.moveTo(static_cast<double>(sample.interval) * settings.step);
      const std::int64_t level = std::int64_t{1} << detail.coarsest();
      const CellAt cell =
          LookAt(ray, majorants, settings, sample.place * settings.step, sample.steps);
      EXPECT_TRUE(cell.visible) << number << " " << sample.place;
      if (sample.steps > level) { // only where little can be seen
        EXPECT_LE(cell.depth, inr::FaintDepth + 1e-9);
        EXPECT_EQ(sample.steps % level, 0);
        ++joined;
      }
      end = sample.interval + sample.steps;
    }
  }
  EXPECT_GT(joined, 200);
}

/// Every step in a cell that can be seen belongs to one sample, which is as fine and stands for as
/// few steps as all cells ask for that it is taken for.
TEST(SampleWalker, TakesWhatCellsAskFor)
{
  const inr::Majorants majorants = MakeMajorants();
  const std::vector<inr::CellSampling> sampling = RandomSampling(majorants);
  inr::MarchSettings settings = Settings();
  settings.cellSampling = sampling.data();
  int taken[4][4] = {};
  for (std::uint64_t number = 0; number < 200; ++number) {
    const inr::Ray ray = RandomRay(number);
    const double jitter = inr::RandomUnit(8, number);
    inr::SampleWalker walker = WalkerOn(ray, majorants, settings, jitter);
    std::int64_t end = 0;
    while (walker.moveToVisible(settings)) {
      const inr::AlikeSamples alike = walker.alike();
      for (; end < walker.next(); ++end) {
        const double t = (static_cast<double>(end) + jitter) * settings.step;
        inr::CellWalker cells(majorants.view(), settings.dims, ray, 0.0, Levels);
        cells.moveTo(t);
        EXPECT_EQ(cells.extinction(), 0.0f) << number << " " << end;
      }
      EXPECT_EQ(end, walker.next()) << number;
      const std::int64_t steps = alike.steps();
      EXPECT_TRUE(alike.last ||
                  walker.offset(alike) == jitter + 0.5 * static_cast<double>(steps - 1));
      const int level = walker.detail().level();
      const int power = steps == 8 ? 3 : steps == 4 ? 2 : steps == 2 ? 1 : 0;
      EXPECT_EQ(steps, std::int64_t{1} << power);
      taken[level][power] += alike.count;
      for (std::int64_t k = 0; k < steps && steps > 1; ++k) { // that the first one is taken for
        inr::CellWalker cells(majorants.view(), settings.dims, ray, 0.0, Levels);
        cells.moveTo((static_cast<double>(end + k) + jitter) * settings.step);
        EXPECT_LE(level, sampling[static_cast<std::size_t>(cells.index())].level);
        EXPECT_LE(power, sampling[static_cast<std::size_t>(cells.index())].power);
      }
      end += steps;
      walker.pass(alike, 1);
    }
  }
  for (int power = 0; power < 4; ++power) {
    EXPECT_GT(taken[power][power], 50);
    EXPECT_GT(taken[0][power], 50);
  }
}

TEST(SampleWalker, EndsWithTheRay)
{
  const inr::MacroCells none;
  inr::Majorants majorants(none);
  majorants.update(inr::ColorTable(UniformMedium(0.5f), inr::VolumeInfo{}), inr::Arena(1));
  const inr::MarchSettings settings = Settings();
  for (std::uint64_t number = 0; number < 100; ++number) {
    const inr::Ray ray = RandomRay(number);
    inr::SampleWalker walker = WalkerOn(ray, majorants, settings, inr::RandomUnit(8, number));
    double end = 0;
    while (walker.moveToVisible(settings)) {
      const inr::AlikeSamples alike = walker.alike();
      EXPECT_EQ(static_cast<double>(walker.next()), end); // without a gap
      const double length = alike.last ? walker.rest() : static_cast<double>(alike.steps());
      EXPECT_LE(static_cast<double>(walker.next()) + walker.offset(alike), walker.end());
      end += length;
      walker.pass(alike, 1);
    }
    EXPECT_NEAR(end, ray.length / settings.step, 1e-9);
  }
}

} // namespace test::sample_walker
