// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/PixelErrors.h"

#include "Core/GridBox.h"
#include "Core/Parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

static_assert(LevelErrors::Coarsest >= LargestCellPower, "what cells ask for is measured");

double LargestOf(const glm::dvec3& edges) { return std::max(edges.x, std::max(edges.y, edges.z)); }

PixelErrors::Error& ErrorWith(PixelErrors::Choices& errors, int level, int power)
{
  const int number = NumberOf({static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(power)});
  return errors[static_cast<std::size_t>(number)];
}

} // namespace

PixelErrors::PixelErrors(const LevelErrors& measured, const Majorants& cells, int coarsest)
    : Measured(measured), Cells(cells.grid(0)), Around(cells.grid(cells.view().gridFor(coarsest))),
      Together(std::lround(this->Around.spacing().x / this->Cells.spacing().x)), Coarsest(coarsest),
      LongestEdge(LargestOf(measured.cellEdge())),
      Slopes(static_cast<std::size_t>(this->Cells.count())), Largest(this->Slopes.size())
{}

const ValueRange& PixelErrors::shown(std::int64_t cell) const
{
  const glm::i64vec3 at = GridPlace(cell, this->Cells.dims());
  return this->Around.range(this->Around.index(at / this->Together));
}

void PixelErrors::set(const ColorLookup& colors, double step, double stepLength, const Arena& arena)
{
  for (int power = 1; power <= LargestCellPower; ++power) {
    const double voxels = step * static_cast<double>(1 << power);
    this->Apart[static_cast<std::size_t>(power - 1)] =
        std::max(1, static_cast<int>(std::ceil(std::log2(voxels))));
  }
  const ColorSensitivity sensitivity(colors, stepLength);
  const auto count = static_cast<std::int64_t>(this->Slopes.size());
  constexpr std::int64_t cellsPerTask = 4096;
  arena.forEachBlock(count, cellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t cell = begin; cell < end; ++cell) {
      const auto at = static_cast<std::size_t>(cell);
      this->Slopes[at] = sensitivity.slopes(this->Cells.range(cell));
      const ValueRange& shown = this->shown(cell);
      const ColorSensitivity::Slopes around = sensitivity.slopes(shown);
      this->Largest[at] =
          shown.empty() ? 0.0f : (around.middle + around.half) * (shown.high - shown.low);
    }
  });
}

bool PixelErrors::isTooLarge(std::int64_t cell, const LineErrors& lines, double limit) const
{
  return !this->canMatter(cell) ||
         !(this->errorOf(cell, lines, this->largestError(cell)).perStep <= limit);
}

PixelErrors::Choices PixelErrors::of(std::int64_t cell) const
{
  const double most = std::isfinite(this->slopes(cell).half) ? this->largestError(cell) : Infinite;
  Choices errors;
  errors.fill({Infinite, most, most});
  for (int level = this->Coarsest + 1; level <= LargestCellPower; ++level) { // there is none
    ErrorWith(errors, level, level) = {Infinite, Infinite, Infinite};
  }
  // What a picture shows must not depend on what others had measured.
  if (!this->UsesMeasured || !this->canMatter(cell)) {
    return errors;
  }
  const LevelErrors::Cell& lines = this->Measured.of(cell);
  // Of one power, and at least that of the one before: fewer samples are not trusted to be better.
  const auto errorOf = [&](const LevelErrors::Powers& powers, int power, const Error& before) {
    if (power > powers.known) {
      return Error{Infinite, Infinite, Infinite};
    }
    const Error error =
        this->errorOf(cell, powers.errors[static_cast<std::size_t>(power - 1)], most);
    return Error{std::max(before.all, error.all), std::max(before.step, error.step),
                 std::max(before.perStep, error.perStep)};
  };
  Error level;
  Error full;
  for (int power = 1; power <= LargestCellPower; ++power) {
    if (power <= this->Coarsest) {
      level = errorOf(lines.levels, power, level);
      ErrorWith(errors, power, power) = level;
    }
    full = errorOf(lines.steps, this->Apart[static_cast<std::size_t>(power - 1)], full);
    ErrorWith(errors, 0, power) = full;
  }
  return errors;
}

PixelErrors::Error PixelErrors::errorOf(std::int64_t cell, const LineErrors& lines,
                                        double most) const
{
  const ColorSensitivity::Slopes& slopes = this->slopes(cell);
  Error error;
  error.all = Unseen * (slopes.middle * lines.sum + slopes.half * lines.magnitude);
  error.step = std::min(most, double{(slopes.middle + slopes.half) * lines.largest});
  error.perStep = std::min(error.step, error.all / this->LongestEdge);
  return error;
}

} // namespace inr
