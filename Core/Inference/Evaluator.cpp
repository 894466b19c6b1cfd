// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/Evaluator.h"

#include "Core/Error.h"
#include "Core/Inference/EvaluateKernel.h"
#include "Core/Inference/GridKernel.h"
#include "Core/Inference/HugePages.h"
#include "Core/Inference/KernelTable.h"

#include <algorithm>
#include <utility>

namespace inr {

namespace {

/// Points per task: enough to amortise scheduling, few enough to share out a small batch.
constexpr std::int64_t TaskSize = 4096;

Layout CheckedLayout(const Model& model)
{
  Layout layout(model.description);
  if (layout.parameterCount != model.parameters.size()) {
    throw Error(ErrorCode::InvalidModel,
                "the description asks for " + std::to_string(layout.parameterCount) +
                    " parameters, the model has " + std::to_string(model.parameters.size()));
  }
  return layout;
}

LatticeAxis ViewOf(const std::vector<float>& axis)
{
  return {axis.data(), static_cast<std::int64_t>(axis.size())};
}

class KernelEvaluator : public Evaluator
{
public:
  KernelEvaluator(ModelPointer model, InstructionSet set)
      : Source(std::move(model)), Set(set), Kernel(EvaluateKernelFor(set)),
        LatticeKernel(GridKernelFor(set)),
        Views(this->Source->description, CheckedLayout(*this->Source),
              this->Source->parameters.data()),
        Network(this->Views.view())
  {
    const std::vector<float>& parameters = this->Source->parameters;
    PreferHugePages(parameters.data(), parameters.size() * sizeof(float));
  }

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    const ModelView& model = this->Network.view();
    const auto floats = static_cast<std::size_t>(this->Kernel.workspace(model));
    const std::unique_ptr<float[]> workspace(new float[floats]); // left as it is: no need for zeros
    this->Kernel.evaluate(model, &positions->x, count, values, workspace.get());
  }

  void evaluateGrid(const std::vector<float> (&axes)[3], float* values) const override
  {
    const ModelView& model = this->Network.view();
    const auto bytes = static_cast<std::size_t>(this->LatticeKernel.workspace(model));
    const std::unique_ptr<unsigned char[]> workspace(new unsigned char[bytes]);
    const LatticeAxis views[3] = {ViewOf(axes[0]), ViewOf(axes[1]), ViewOf(axes[2])};
    this->LatticeKernel.evaluate(model, views, values, workspace.get());
  }

  std::string kernel() const override { return InstructionSetName(this->Set); }

private:
  ModelPointer Source;
  InstructionSet Set;
  const EvaluateKernel& Kernel;
  const GridKernel& LatticeKernel;
  ModelViewStorage Views;
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

const GridKernel& GridKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Grid); }

const EvaluateKernel& EvaluateKernelFor(InstructionSet set)
{
  return INR_KERNEL_FOR(set, Evaluate);
}

std::shared_ptr<const Evaluator> MakeEvaluator(ModelPointer model, const std::string& kernel)
{
  return std::make_shared<KernelEvaluator>(std::move(model), ChooseInstructionSet(kernel));
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
  const std::int64_t total = points.x * points.y * points.z;
  arena.forEachBlock(total, TaskSize, [&](std::int64_t begin, std::int64_t end) {
    std::vector<glm::vec3> positions(static_cast<std::size_t>(end - begin));
    for (std::int64_t k = begin; k < end; ++k) {
      const glm::dvec3 index(k % points.x, k / points.x % points.y, k / (points.x * points.y));
      positions[static_cast<std::size_t>(k - begin)] = lattice.first + index * lattice.step;
    }
    evaluator.evaluate(positions.data(), end - begin, values + begin);
  });
}

Lattice VoxelLattice(const glm::i64vec3& dims, const glm::i64vec3& begin, const glm::i64vec3& size)
{
  const glm::dvec3 step = 1.0 / glm::dvec3(dims);
  return {(glm::dvec3(begin) + 0.5) * step, step, size};
}

} // namespace inr
