// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/Evaluator.h"

#include "Core/Error.h"
#include "Core/GridBox.h"
#include "Core/Inference/HugePages.h"
#include "Core/Inference/InferenceKernels.h"
#include "Core/Inference/OverflowWatch.h"
#include "Core/Inference/WideEvaluation.h"
#include "Core/Random.h"

#include <algorithm>
#include <utility>

namespace inr {

namespace {

/// Points per task: enough to amortise scheduling, few enough to share out a small batch.
constexpr std::int64_t TaskSize = 4096;

LatticeAxis ViewOf(const std::vector<float>& axis)
{
  return {axis.data(), static_cast<std::int64_t>(axis.size())};
}

/// Whether values are off, in the root of the mean square, by no more than what they are when they
/// are rounded to 16 bits of [0, 1].
bool RoundsLessThan16Bits(const Evaluator& rounded, const Evaluator& exact)
{
  constexpr std::size_t count = 2048;
  constexpr double step = 1.0 / 65535;
  std::vector<glm::vec3> positions(count);
  for (std::size_t k = 0; k < count; ++k) {
    positions[k] = {RandomUnit(1, 3 * k), RandomUnit(1, 3 * k + 1), RandomUnit(1, 3 * k + 2)};
  }
  std::vector<float> values[2] = {std::vector<float>(count), std::vector<float>(count)};
  rounded.evaluate(positions.data(), count, values[0].data());
  exact.evaluate(positions.data(), count, values[1].data());
  double squares = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double error = static_cast<double>(values[0][k]) - static_cast<double>(values[1][k]);
    squares += error * error;
  }
  return squares / count <= step * step / 12.0;
}

/// Of points [begin, end) along an axis, clamped to [0, 1]; a NaN is 0.
std::vector<float> CoordinatesOf(const Lattice& lattice, int axis, std::int64_t begin,
                                 std::int64_t end)
{
  std::vector<float> coordinates;
  coordinates.reserve(static_cast<std::size_t>(end - begin));
  for (std::int64_t k = begin; k < end; ++k) {
    const double u = lattice.first[axis] + static_cast<double>(k) * lattice.step[axis];
    coordinates.push_back(static_cast<float>(u > 0 ? std::min(u, 1.0) : 0.0));
  }
  return coordinates;
}

/// Of a part of a lattice, from `begin` up to `end`, into the lattice's `values`.
void EvaluatePart(const Evaluator& evaluator, const Lattice& lattice, const glm::i64vec3& begin,
                  const glm::i64vec3& end, float* values)
{
  const glm::i64vec3 size = end - begin;
  const std::vector<float> axes[3] = {CoordinatesOf(lattice, 0, begin.x, end.x),
                                      CoordinatesOf(lattice, 1, begin.y, end.y),
                                      CoordinatesOf(lattice, 2, begin.z, end.z)};
  std::vector<float> part(static_cast<std::size_t>(GridCount(size)));
  evaluator.evaluateGrid(axes, part.data());
  for (std::int64_t row = 0; row < size.y * size.z; ++row) {
    const std::int64_t y = begin.y + row % size.y;
    const std::int64_t z = begin.z + row / size.y;
    std::copy_n(part.data() + row * size.x, size.x,
                values + GridNumber({begin.x, y, z}, lattice.points));
  }
}

ModelPointer RequireModel(ModelPointer model)
{
  if (!model) {
    throw Error(ErrorCode::InvalidArgument, "an evaluator needs a model");
  }
  return model;
}

class KernelEvaluator : public Evaluator
{
public:
  /// `choose` gives InferenceKernels for a ModelView.
  template <class Choose>
  KernelEvaluator(ModelPointer model, const Choose& choose)
      : Source(RequireModel(std::move(model))),
        Views(this->Source->description, CheckedLayout(*this->Source),
              this->Source->parameters.data()),
        Kernels(choose(this->Views.view())), Network(this->Views.view(), this->Kernels.layout)
  {
    const AlignedVector<float>& parameters = this->Source->parameters;
    PreferHugePages(parameters.data(), parameters.size() * sizeof(float));
  }

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    if (count == 0) { // then there need not be an array of positions
      return;
    }
    const ModelView& model = this->Network.view();
    const auto floats = static_cast<std::size_t>(this->Kernels.points->workspace(model));
    const std::unique_ptr<float[]> workspace(new float[floats]); // left as it is: no need for zeros
    OverflowWatch watch;
    this->Kernels.points->evaluate(model, &positions->x, count, values, workspace.get());
    if (watch.overflowed()) {
      this->widen(positions, count, values, workspace.get(), watch);
    }
  }

  void evaluateGrid(const std::vector<float> (&axes)[3], float* values) const override
  {
    if (axes[0].empty() || axes[1].empty() || axes[2].empty()) {
      return;
    }
    const ModelView& model = this->Network.view();
    const auto bytes = static_cast<std::size_t>(this->Kernels.lattices->workspace(model));
    const std::unique_ptr<unsigned char[]> workspace(new unsigned char[bytes]);
    const LatticeAxis views[3] = {ViewOf(axes[0]), ViewOf(axes[1]), ViewOf(axes[2])};
    OverflowWatch watch;
    this->Kernels.lattices->evaluate(model, views, values, workspace.get());
    if (watch.overflowed()) {
      this->widenGrid(views, values, workspace.get(), watch);
    }
  }

  glm::i64vec3 resolution() const override { return ResolutionOf(*this->Source); }
  std::string kernel() const override { return this->Kernels.name; }
  bool splits() const { return this->Kernels.layout == WeightLayout::SplitTiles; }

private:
  /// Values of `count` positions some of which overflow: halves them until it is known which do, so
  /// that a value stays independent of its neighbours in the batch.
  void widen(const glm::vec3* positions, std::int64_t count, float* values, float* workspace,
             OverflowWatch& watch) const
  {
    if (count == 1) {
      *values = EvaluateWide(this->Network.view(), &positions->x);
      return;
    }
    const std::int64_t half = count / 2;
    for (const auto& [first, size] : {std::pair{std::int64_t{0}, half}, {half, count - half}}) {
      watch.restart();
      this->Kernels.points->evaluate(this->Network.view(), &positions[first].x, size,
                                     values + first, workspace);
      if (watch.overflowed()) {
        this->widen(positions + first, size, values + first, workspace, watch);
      }
    }
  }

  /// The same for a lattice.
  void widenGrid(const LatticeAxis (&axes)[3], float* values, void* workspace,
                 OverflowWatch& watch) const
  {
    int slowest = 2; // the slowest axis that can be halved: the halves are contiguous in `values`
    while (slowest > 0 && axes[slowest].count == 1) {
      --slowest;
    }
    const std::int64_t count = axes[slowest].count;
    if (count == 1) {
      const float position[3] = {*axes[0].u, *axes[1].u, *axes[2].u};
      *values = EvaluateWide(this->Network.view(), position);
      return;
    }
    const std::int64_t points = axes[0].count * axes[1].count * axes[2].count;
    const std::int64_t half = count / 2;
    for (const auto& [first, size] : {std::pair{std::int64_t{0}, half}, {half, count - half}}) {
      LatticeAxis part[3] = {axes[0], axes[1], axes[2]};
      part[slowest] = {axes[slowest].u + first, size};
      watch.restart();
      this->Kernels.lattices->evaluate(this->Network.view(), part, values + points / count * first,
                                       workspace);
      if (watch.overflowed()) {
        this->widenGrid(part, values + points / count * first, workspace, watch);
      }
    }
  }

  ModelPointer Source;
  ModelViewStorage Views;
  InferenceKernels Kernels;
  PackedNetwork Network;
};

} // namespace

void Evaluator::evaluateGrid(const std::vector<float> (&axes)[3], float* values) const
{
  std::vector<glm::vec3> positions;
  positions.reserve(axes[0].size() * axes[1].size() * axes[2].size());
  for (const float z : axes[2]) {
    for (const float y : axes[1]) {
      for (const float x : axes[0]) {
        positions.emplace_back(x, y, z);
      }
    }
  }
  this->evaluate(positions.data(), static_cast<std::int64_t>(positions.size()), values);
}

std::shared_ptr<const Evaluator> MakeEvaluator(ModelPointer model, const std::string& kernel,
                                               InferencePrecision precision)
{
  const auto make = [&](InferencePrecision wanted) {
    return std::make_shared<const KernelEvaluator>(model, [&](const ModelView& view) {
      const bool can = wanted == InferencePrecision::Float32 || StaysInRange(view);
      return ChooseKernels(kernel, can ? wanted : InferencePrecision::Float32);
    });
  };
  auto evaluator = make(precision);
  if (precision != InferencePrecision::SplitBFloat16 || !evaluator->splits()) {
    return evaluator;
  }
  auto exact = make(InferencePrecision::Float32);
  return RoundsLessThan16Bits(*evaluator, *exact) ? evaluator : exact;
}

std::shared_ptr<const Evaluator> MakeEvaluator(ModelPointer model, const InferenceKernels& kernels)
{
  return std::make_shared<KernelEvaluator>(std::move(model),
                                           [&](const ModelView&) { return kernels; });
}

void EvaluateParallel(const Evaluator& evaluator, const Arena& arena, const glm::vec3* positions,
                      std::int64_t count, float* values)
{
  arena.forEachBlock(count, TaskSize, [&](std::int64_t begin, std::int64_t end) {
    evaluator.evaluate(positions + begin, end - begin, values + begin);
  });
}

void EvaluateLattice(const Evaluator& evaluator, const Arena& arena, const Lattice& lattice,
                     float* values)
{
  constexpr std::int64_t longest = 512; // of a row: some more beside it share its corners
  const glm::i64vec3 points = lattice.points;
  if (GridCount(points) == 0) {
    return;
  }
  glm::i64vec3 size;
  size.x = std::min(points.x, longest);
  size.y = std::clamp<std::int64_t>(TaskSize / size.x, 1, points.y);
  size.z = std::clamp<std::int64_t>(TaskSize / (size.x * size.y), 1, points.z);
  const glm::i64vec3 parts = (points + size - std::int64_t{1}) / size;
  arena.forEachBlock(GridCount(parts), 1, [&](std::int64_t task, std::int64_t) {
    const glm::i64vec3 part(task % parts.x, task / parts.x % parts.y, task / (parts.x * parts.y));
    const glm::i64vec3 begin = part * size;
    EvaluatePart(evaluator, lattice, begin, glm::min(begin + size, points), values);
  });
}

Lattice VoxelLattice(const glm::i64vec3& dims, const glm::i64vec3& begin, const glm::i64vec3& size)
{
  const glm::dvec3 step = 1.0 / glm::dvec3(dims);
  return {(glm::dvec3(begin) + 0.5) * step, step, size};
}

} // namespace inr
