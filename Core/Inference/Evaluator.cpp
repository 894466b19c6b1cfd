// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/Evaluator.h"

#include "Core/Error.h"
#include "Core/Inference/HugePages.h"
#include "Core/Inference/InferenceKernels.h"
#include "Core/Inference/OverflowWatch.h"
#include "Core/Inference/WideEvaluation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace inr {

namespace {

/// Points per task: enough to amortise scheduling, few enough to share out a small batch.
constexpr std::int64_t TaskSize = 4096;

/// By bits, which vectorises: a float without its sign grows with them.
std::uint32_t LargestMagnitudeBits(const std::vector<float>& values)
{
  std::uint32_t largest = 0;
  for (const float& value : values) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    largest = std::max(largest, bits & 0x7fffffffu);
  }
  return largest;
}

void RequireFinite(const std::vector<float>& parameters)
{
  constexpr std::uint32_t infinity = 0x7f800000u;
  if (LargestMagnitudeBits(parameters) < infinity) {
    return;
  }
  const auto bad = std::find_if(parameters.begin(), parameters.end(),
                                [](float parameter) { return !std::isfinite(parameter); });
  throw Error(ErrorCode::InvalidModel, "parameter " + std::to_string(bad - parameters.begin()) +
                                           " of the model is " + std::to_string(*bad) +
                                           "; train it again");
}

Layout CheckedLayout(const Model& model)
{
  Layout layout(model.description);
  if (layout.parameterCount != model.parameters.size()) {
    throw Error(ErrorCode::InvalidModel,
                "the description asks for " + std::to_string(layout.parameterCount) +
                    " parameters, the model has " + std::to_string(model.parameters.size()));
  }
  RequireFinite(model.parameters);
  return layout;
}

LatticeAxis ViewOf(const std::vector<float>& axis)
{
  return {axis.data(), static_cast<std::int64_t>(axis.size())};
}

/// Of points [begin, end) along an axis.
std::vector<float> CoordinatesOf(const Lattice& lattice, int axis, std::int64_t begin,
                                 std::int64_t end)
{
  std::vector<float> coordinates;
  coordinates.reserve(static_cast<std::size_t>(end - begin));
  for (std::int64_t k = begin; k < end; ++k) {
    coordinates.push_back(
        static_cast<float>(lattice.first[axis] + static_cast<double>(k) * lattice.step[axis]));
  }
  return coordinates;
}

class KernelEvaluator : public Evaluator
{
public:
  /// `choose` gives InferenceKernels for a ModelView.
  template <class Choose>
  KernelEvaluator(ModelPointer model, const Choose& choose)
      : Source(std::move(model)), Views(this->Source->description, CheckedLayout(*this->Source),
                                        this->Source->parameters.data()),
        Kernels(choose(this->Views.view())), Network(this->Views.view(), this->Kernels.layout)
  {
    const std::vector<float>& parameters = this->Source->parameters;
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

  std::string kernel() const override { return this->Kernels.name; }

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
  return std::make_shared<KernelEvaluator>(std::move(model), [&](const ModelView& view) {
    const bool can = precision == InferencePrecision::Float32 || StaysInRange(view);
    return ChooseKernels(kernel, can ? precision : InferencePrecision::Float32);
  });
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
  const glm::i64vec3 points = lattice.points;
  if (points.x * points.y * points.z == 0) {
    return;
  }
  // Tasks are boxes of whole rows, which lie in `values` as evaluateGrid writes them.
  const std::int64_t rows = std::clamp<std::int64_t>(TaskSize / points.x, 1, points.y);
  const std::int64_t layers =
      rows < points.y ? 1 : std::clamp<std::int64_t>(TaskSize / (points.x * rows), 1, points.z);
  const std::int64_t bands = (points.y + rows - 1) / rows; // to a layer
  const std::int64_t slabs = (points.z + layers - 1) / layers;
  const std::vector<float> x = CoordinatesOf(lattice, 0, 0, points.x);
  arena.forEachBlock(bands * slabs, 1, [&](std::int64_t task, std::int64_t) {
    const std::int64_t j = task % bands * rows;
    const std::int64_t k = task / bands * layers;
    const std::vector<float> axes[3] = {
        x, CoordinatesOf(lattice, 1, j, std::min(j + rows, points.y)),
        CoordinatesOf(lattice, 2, k, std::min(k + layers, points.z))};
    evaluator.evaluateGrid(axes, values + (k * points.y + j) * points.x);
  });
}

Lattice VoxelLattice(const glm::i64vec3& dims, const glm::i64vec3& begin, const glm::i64vec3& size)
{
  const glm::dvec3 step = 1.0 / glm::dvec3(dims);
  return {(glm::dvec3(begin) + 0.5) * step, step, size};
}

} // namespace inr
