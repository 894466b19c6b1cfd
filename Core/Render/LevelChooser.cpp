// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/LevelChooser.h"

#include "Core/Parallel.h"
#include "Core/Render/CellBlock.h"
#include "Core/Render/TileLoop.h"
#include "Core/Render/Timer.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace inr {

namespace {

constexpr std::int64_t CellsPerTask = 4096;
constexpr std::int64_t RaysPerTask = 64;
/// A picture, at most: 48^2 rays take a hundredth of the time that those of 512x512 pixels take.
constexpr int RaysAcross = 48;
/// Light from behind, where rays end: what no ray meets before has its finest level, and of what
/// others allow there, so much adds to a ray's error.
constexpr double Hidden = 1e-3;
static_assert(LevelErrors::Coarsest >= LargestCellPower, "what cells ask for is measured");

double LargestOf(const glm::dvec3& edges) { return std::max(edges.x, std::max(edges.y, edges.z)); }

/// Of a step whose value may be anything in a range.
double LargestError(const ColorSensitivity::Slopes& slopes, const ValueRange& range)
{
  return range.empty() ? 0.0 : (slopes.middle + slopes.half) * (range.high - range.low);
}

/// Pixels of a rectangle, as far apart as that they are RaysAcross or fewer across and down.
class PixelGrid
{
public:
  PixelGrid(const glm::ivec2& first, const glm::ivec2& size)
      : First(first), Size(size), Apart((std::max(size.x, size.y) + RaysAcross - 1) / RaysAcross),
        Across((size.x + this->Apart - 1) / this->Apart),
        Down((size.y + this->Apart - 1) / this->Apart)
  {}
  int apart() const { return this->Apart; }
  std::int64_t count() const { return this->Across * this->Down; }
  glm::ivec2 pixel(std::int64_t number) const
  {
    const glm::ivec2 place(number % this->Across, number / this->Across);
    return this->First + glm::min(place * this->Apart + this->Apart / 2, this->Size - 1);
  }

private:
  glm::ivec2 First;
  glm::ivec2 Size;
  int Apart;
  std::int64_t Across;
  std::int64_t Down;
};

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

/// A ray's sums, for each of the limits, and the cells that they are of.
struct LevelChooser::RayWalk
{
  std::array<double, LimitCount> sums;
  std::vector<std::int64_t> cells;
};

LevelChooser::LevelChooser(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
                           const MajorantGrid& cells, int levels, const LineKernel& kernel)
    : Field(std::move(field)), Kernel(kernel), Dims(dims),
      Errors(dims, cells.dims(), cells.spacing()),
      Coarsest(std::min(levels - 1, LevelErrors::Coarsest)),
      LongestEdge(LargestOf(this->Errors.cellEdge())),
      Slopes(static_cast<std::size_t>(cells.count())),
      Allowed(new std::atomic<std::uint8_t>[static_cast<std::size_t>(cells.count())]),
      Needs(new std::atomic<std::uint8_t>[static_cast<std::size_t>(this->Errors.blocks())]),
      Sampling(static_cast<std::size_t>(cells.count()))
{}

bool LevelChooser::choose(const Wish& wish, const View& view, const Majorants& majorants,
                          const ColorLookup& colors, const Arena& arena, const WorkLimit& limit,
                          const std::function<bool()>& keepGoing)
{
  const bool known = this->IsCurrent && this->Given == wish;
  this->IsCurrent = false; // should measuring be stopped
  this->Given = wish;
  this->LeastError = wish.tolerance * wish.step / std::max(wish.step, view.geometry.longest());
  this->UsesMeasured = true;
  if (!known) {
    this->setLimits();
    this->findSlopes(majorants.grid(0), colors, arena);
  }
  this->sendRays(view, majorants, arena);
  const std::vector<std::int64_t> seen = this->blocksWith(Seen);
  const std::vector<std::int64_t> left = this->blocksWith(NotKnown);
  this->UsesMeasured = !this->areTooMany(static_cast<std::int64_t>(seen.size()));
  if (this->UsesMeasured && !left.empty()) {
    this->forgetOthersThan(seen);
    if (!this->measure(left, majorants.grid(0), arena, limit, keepGoing)) {
      return false;
    }
  }
  if (!left.empty() || !this->UsesMeasured) {
    this->sendRays(view, majorants, arena);
  }
  this->chooseLevels(majorants.grid(0), arena);
  this->IsCurrent = true;
  return true;
}

void LevelChooser::setLimits()
{
  for (std::size_t k = 0; k < LimitCount; ++k) {
    this->Limits[k] = this->Given.tolerance * std::exp2(-0.5 * static_cast<double>(k));
  }
  this->Limits[LimitCount] = 0;
  for (int power = 1; power <= LargestCellPower; ++power) {
    const double voxels = this->Given.step * static_cast<double>(1 << power);
    this->Apart[static_cast<std::size_t>(power - 1)] =
        std::max(1, static_cast<int>(std::ceil(std::log2(voxels))));
  }
}

void LevelChooser::findSlopes(const MajorantGrid& cells, const ColorLookup& colors,
                              const Arena& arena)
{
  const ColorSensitivity sensitivity(colors, this->Given.stepLength);
  const auto count = static_cast<std::int64_t>(this->Slopes.size());
  arena.forEachBlock(count, CellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t cell = begin; cell < end; ++cell) {
      this->Slopes[static_cast<std::size_t>(cell)] = sensitivity.slopes(cells.range(cell));
    }
  });
}

void LevelChooser::sendRays(const View& view, const Majorants& majorants, const Arena& arena)
{
  Clear(this->Allowed, static_cast<std::int64_t>(this->Sampling.size()));
  Clear(this->Needs, this->Errors.blocks());
  const PixelGrid all({0, 0}, {view.width, view.height});
  glm::ivec2 low(view.width, view.height);
  glm::ivec2 high(-1);
  for (std::int64_t k = 0; k < all.count(); ++k) {
    const glm::ivec2 pixel = all.pixel(k);
    if (view.geometry.ray(pixel.x, pixel.y).length > 0) {
      low = glm::min(low, pixel - all.apart());
      high = glm::max(high, pixel + all.apart());
    }
  }
  // Where the volume is small in the picture, or missed so far, rays are closer.
  low = high.x < 0 ? glm::ivec2(0) : glm::max(low, glm::ivec2(0));
  high = high.x < 0 ? glm::ivec2(view.width, view.height)
                    : glm::min(high + 1, glm::ivec2(view.width, view.height));
  const PixelGrid seen(low, high - low);
  arena.forEachBlock(seen.count(), RaysPerTask, [&](std::int64_t begin, std::int64_t end) {
    RayWalk walk;
    for (std::int64_t k = begin; k < end; ++k) {
      const glm::ivec2 pixel = seen.pixel(k);
      const Ray ray = view.geometry.ray(pixel.x, pixel.y);
      if (ray.length > 0) {
        this->follow(ray, majorants, walk);
      }
    }
  });
}

void LevelChooser::follow(const Ray& ray, const Majorants& majorants, RayWalk& walk)
{
  walk.sums.fill(0.0);
  walk.cells.clear();
  const MajorantGrid& grid = majorants.grid(0);
  const LevelErrors::Question question = this->question(grid);
  CellWalker cells(majorants, this->Dims, ray, 0.0, 1);
  cells.moveTo(0);
  const double stepsPerVoxel = 1.0 / (this->Given.step * glm::length(ray.direction));
  double light = 1.0; // of what is here, that is seen
  for (double t = 0; t < ray.length && light > Hidden && cells.moveToVisible(ray.length);) {
    const std::int64_t cell = cells.index();
    const double exit = std::min(cells.exit(), ray.length);
    const double steps = (exit - std::max(t, cells.enter())) / this->Given.step;
    // Rays beside this one may go all through a cell of which it meets a corner.
    const double crossing = std::max(steps, stepsPerVoxel * this->LongestEdge);
    const CellErrors errors = this->errorsOf(cell, grid.range(cell));
    walk.cells.push_back(cell);
    int number = 0;
    for (std::size_t k = 0; k < LimitCount; ++k) {
      number = choiceFor(errors, this->Limits[k], number);
      if (number == Choices) {
        break; // nor do smaller limits allow anything
      }
      const CellError& error = errors[static_cast<std::size_t>(number)];
      walk.sums[k] += light * std::min(stepsPerVoxel * error.all, crossing * error.step);
    }
    if (this->canMatter(cell, grid.range(cell))) {
      Raise(this->Needs[static_cast<std::size_t>(this->Errors.blockOf(cell))],
            this->Errors.knows(cell, question) ? Seen : NotKnown);
    }
    light *= std::exp(-steps * this->Slopes[static_cast<std::size_t>(cell)].depth);
    t = exit;
    if (t < ray.length) {
      cells.moveTo(t);
    }
  }
  const auto within = std::find_if(walk.sums.begin(), walk.sums.end(),
                                   [this](double sum) { return sum <= this->Given.tolerance; });
  const auto number = static_cast<int>(within - walk.sums.begin());
  for (const std::int64_t cell : walk.cells) {
    Raise(this->Allowed[static_cast<std::size_t>(cell)], number + 1);
  }
}

bool LevelChooser::canMatter(std::int64_t cell, const ValueRange& range) const
{
  const ColorSensitivity::Slopes& slopes = this->Slopes[static_cast<std::size_t>(cell)];
  return LargestError(slopes, range) > this->LeastError && std::isfinite(slopes.half);
}

LevelErrors::Question LevelChooser::question(const MajorantGrid& cells) const
{
  return {this->Coarsest, this->Apart.back(),
          [this, &cells](std::int64_t cell, const LineErrors& lines) {
            const ValueRange range = cells.range(cell);
            const double most = LargestError(this->Slopes[static_cast<std::size_t>(cell)], range);
            return !this->canMatter(cell, range) ||
                   !(this->errorOf(cell, lines, most).perStep <= this->Limits[0]);
          }};
}

std::vector<std::int64_t> LevelChooser::blocksWith(Need need) const
{
  std::vector<std::int64_t> blocks;
  for (std::int64_t block = 0; block < this->Errors.blocks(); ++block) {
    if (this->Needs[static_cast<std::size_t>(block)] >= need) {
      blocks.push_back(block);
    }
  }
  return blocks;
}

bool LevelChooser::areTooMany(std::int64_t blocks) const
{
  const std::int64_t cost = this->Errors.blockCost();
  return cost > LargestBlock || blocks > MostVoxels / cost ||
         blocks > MostCells / this->Errors.cellsPerBlock();
}

void LevelChooser::forgetOthersThan(const std::vector<std::int64_t>& seen)
{
  const std::int64_t blocks =
      this->Errors.measuredBlocks() + static_cast<std::int64_t>(seen.size());
  if (blocks <= MostCells / this->Errors.cellsPerBlock()) {
    return;
  }
  for (std::int64_t block = 0; block < this->Errors.blocks(); ++block) {
    if (!std::binary_search(seen.begin(), seen.end(), block)) {
      this->Errors.forget(block);
    }
  }
}

bool LevelChooser::measure(const std::vector<std::int64_t>& left, const MajorantGrid& cells,
                           const Arena& arena, const WorkLimit& limit,
                           const std::function<bool()>& keepGoing)
{
  LevelErrors::Question question = this->question(cells);
  question.isTooLarge = [this, known = std::move(question.isTooLarge)](std::int64_t cell,
                                                                       const LineErrors& lines) {
    return this->Allowed[static_cast<std::size_t>(cell)] == 0 || known(cell, lines); // not met
  };
  const auto count = static_cast<std::int64_t>(left.size());
  const std::int64_t round = limit.isTimed() ? arena.threads() : count;
  for (std::int64_t first = 0; first < count; first += round) {
    if (first > 0 && limit.isTimed() && limit.endsWithin(this->SecondsPerRound)) {
      return false;
    }
    const Timer timer;
    std::atomic<std::int64_t> points{0};
    ForEachTile(arena, std::min(round, count - first), keepGoing, [&](std::int64_t k) {
      points += this->Errors.measure(left[static_cast<std::size_t>(first + k)], *this->Field,
                                     this->Kernel, question, [&] { RequireGoing(keepGoing); });
    });
    this->Points += points;
    if (round < count) {
      this->SecondsPerRound = timer.seconds();
    }
  }
  return true;
}

void LevelChooser::chooseLevels(const MajorantGrid& cells, const Arena& arena)
{
  const auto count = static_cast<std::int64_t>(this->Sampling.size());
  arena.forEachBlock(count, CellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t cell = begin; cell < end; ++cell) {
      const auto at = static_cast<std::size_t>(cell);
      const std::uint8_t number = this->Allowed[at];
      this->Sampling[at] = number == 0 ? CellSampling{}
                                       : choice(choiceFor(this->errorsOf(cell, cells.range(cell)),
                                                          this->Limits[number - 1u], 0));
    }
  });
}

LevelChooser::CellErrors LevelChooser::errorsOf(std::int64_t cell, const ValueRange& range) const
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const bool isBounded = std::isfinite(this->Slopes[static_cast<std::size_t>(cell)].half);
  const double most =
      isBounded ? LargestError(this->Slopes[static_cast<std::size_t>(cell)], range) : infinite;
  CellErrors errors;
  errors.fill({infinite, most, most});
  const auto errorsWith = [&errors](int level, int power) -> CellError& {
    const int number =
        numberOf({static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(power)});
    return errors[static_cast<std::size_t>(number)];
  };
  for (int level = this->Coarsest + 1; level <= LargestCellPower; ++level) { // there is none
    errorsWith(level, level) = {infinite, infinite, infinite};
  }
  // What a picture shows must not depend on what others had measured.
  if (!this->UsesMeasured || !this->canMatter(cell, range)) {
    return errors;
  }
  const LevelErrors::Cell& lines = this->Errors.of(cell);
  const auto errorOf = [&](const LevelErrors::Powers& powers, int power, const CellError& less) {
    if (power > powers.known) {
      return CellError{infinite, infinite, infinite};
    }
    const CellError error =
        this->errorOf(cell, powers.errors[static_cast<std::size_t>(power - 1)], most);
    // Fewer samples are not trusted to be better.
    return CellError{std::max(less.all, error.all), std::max(less.step, error.step),
                     std::max(less.perStep, error.perStep)};
  };
  CellError level;
  CellError full;
  for (int power = 1; power <= LargestCellPower; ++power) {
    if (power <= this->Coarsest) {
      level = errorOf(lines.levels, power, level);
      errorsWith(power, power) = level;
    }
    full = errorOf(lines.steps, this->Apart[static_cast<std::size_t>(power - 1)], full);
    errorsWith(0, power) = full;
  }
  return errors;
}

LevelChooser::CellError LevelChooser::errorOf(std::int64_t cell, const LineErrors& lines,
                                              double most) const
{
  const ColorSensitivity::Slopes& slopes = this->Slopes[static_cast<std::size_t>(cell)];
  CellError error;
  error.all = slopes.middle * lines.sum + slopes.half * lines.magnitude;
  error.step = std::min(most, double{(slopes.middle + slopes.half) * lines.largest});
  error.perStep = std::min(error.step, error.all / this->LongestEdge);
  return error;
}

int LevelChooser::choiceFor(const CellErrors& errors, double limit, int first)
{
  while (first < Choices && !(errors[static_cast<std::size_t>(first)].perStep <= limit)) {
    ++first;
  }
  return first;
}

} // namespace inr
