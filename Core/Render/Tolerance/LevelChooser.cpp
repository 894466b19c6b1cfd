// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/LevelChooser.h"

#include "Core/Parallel.h"

#include <algorithm>
#include <utility>

namespace inr {

LevelChooser::LevelChooser(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
                           const Majorants& cells, int levels, const LineKernel& kernel)
    : Dims(dims), Coarsest(std::min(levels - 1, LevelErrors::Coarsest)),
      Measurement(std::move(field), dims, cells.grid(0).dims(), cells.grid(0).spacing(), kernel),
      Errors(this->Measurement.errors(), cells, this->Coarsest),
      Rays(cells.grid(0).count(), this->Measurement.errors().blocks()),
      Sampling(static_cast<std::size_t>(cells.grid(0).count()))
{}

bool LevelChooser::choose(const Wish& wish, const View& view, const Majorants& majorants,
                          const ColorLookup& colors, const Arena& arena, const WorkLimit& limit,
                          const std::function<bool()>& keepGoing)
{
  this->prepare(wish, view, colors, arena);
  this->Errors.useMeasured(true);
  this->lookAhead(view, majorants, arena);
  const std::vector<std::int64_t> seen = this->Rays.blocksWith(LookAhead::Seen);
  const std::vector<std::int64_t> left = this->Rays.blocksWith(LookAhead::NotKnown);
  const bool usesMeasured = !this->Measurement.areTooMany(static_cast<std::int64_t>(seen.size()));
  if (usesMeasured && !left.empty()) {
    this->Measurement.forgetOthersThan(seen);
    if (!this->measure(left, arena, limit, keepGoing)) {
      return false;
    }
  }
  this->Errors.useMeasured(usesMeasured);
  if (!left.empty() || !usesMeasured) {
    this->lookAhead(view, majorants, arena); // with what is known now
  }
  this->chooseSamples(arena);
  this->IsCurrent = true;
  return true;
}

void LevelChooser::prepare(const Wish& wish, const View& view, const ColorLookup& colors,
                           const Arena& arena)
{
  const bool known = this->IsCurrent && this->Given == wish;
  this->IsCurrent = false; // should measuring be stopped
  this->Given = wish;
  const double tolerance = MadeUseOf * wish.tolerance / 255.0;
  // As much of it as of the longest ray's steps one is.
  this->Errors.ignoreBelow(tolerance * wish.step / std::max(wish.step, view.geometry.longest()));
  if (!known) {
    this->Rays.setTolerance(tolerance);
    this->Errors.set(colors, wish.step, wish.stepLength, arena);
  }
}

void LevelChooser::lookAhead(const View& view, const Majorants& majorants, const Arena& arena)
{
  const LevelErrors::Question question{this->Coarsest, this->Errors.powersOfSteps(),
                                       [this](std::int64_t cell, const LineErrors& lines) {
                                         return this->Errors.isTooLarge(cell, lines,
                                                                        this->Rays.largestLimit());
                                       }};
  this->Rays.send(
      view,
      {majorants, this->Errors, this->Measurement.errors(), question, this->Dims, this->Given.step},
      arena);
}

bool LevelChooser::measure(const std::vector<std::int64_t>& blocks, const Arena& arena,
                           const WorkLimit& limit, const std::function<bool()>& keepGoing)
{
  // Not those that a block holds beside the ones that rays meet.
  const LevelErrors::Question question{this->Coarsest, this->Errors.powersOfSteps(),
                                       [this](std::int64_t cell, const LineErrors& lines) {
                                         return !this->Rays.meets(cell) ||
                                                this->Errors.isTooLarge(cell, lines,
                                                                        this->Rays.largestLimit());
                                       }};
  return this->Measurement.measure(blocks, question, arena, limit, keepGoing);
}

bool LevelChooser::choosesFor(const Frame& frame, bool rangesHold)
{
  // Values that leave their cell's range are moved into that of all cells that are walked through
  // together, and these are others where there are fewer samples.
  return frame.errorTolerance.value_or(0) > 0 && rangesHold &&
         frame.mode == RenderMode::RayMarching && frame.blending.mode == BlendMode::Composite &&
         !frame.shading && !(frame.cropping && !BoxOf(*frame.cropping).full) &&
         frame.sampleDistance <= LongestStep;
}

void LevelChooser::chooseSamples(const Arena& arena)
{
  const auto count = static_cast<std::int64_t>(this->Sampling.size());
  constexpr std::int64_t cellsPerTask = 4096;
  arena.forEachBlock(count, cellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t cell = begin; cell < end; ++cell) {
      this->Sampling[static_cast<std::size_t>(cell)] =
          this->Rays.meets(cell)
              ? SampleChoice(FewestSamples(this->Errors.of(cell), this->Rays.limit(cell)))
              : CellSampling{};
    }
  });
}

} // namespace inr
