// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Quality/PsnrEstimate.h"

#include "Core/Model/Model.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Training/Samples/HalvedCube.h"
#include "Core/Training/Samples/RandomStream.h"
#include "Core/Training/Samples/VoxelDraw.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace inr {

namespace {
constexpr std::int64_t BlockSize = 64; ///< between two checks: a wide network takes long
constexpr std::int64_t TaskSize = 1024;

std::vector<float> TargetsAt(const SampleSource& source, const std::vector<glm::vec3>& positions)
{
  std::vector<float> targets(positions.size());
  source.sample(positions.data(), static_cast<std::int64_t>(targets.size()), targets.data());
  return targets;
}

} // namespace

std::vector<glm::vec3> PsnrEstimate::positions(const glm::i64vec3& dims, std::uint64_t seed,
                                               std::int64_t voxels)
{
  const std::uint64_t stream = StreamSeed(seed, RandomStream::Estimate);
  std::vector<glm::vec3> positions(static_cast<std::size_t>(voxels));
  for (std::size_t k = 0; k < positions.size(); ++k) {
    positions[k] = VoxelCentre(RandomPosition(stream, k, dims), dims);
  }
  return positions;
}

PsnrEstimate::Choice PsnrEstimate::Choose(const SampleSource& source, std::uint64_t seed,
                                          const Arena& arena, std::int64_t voxels)
{
  const std::optional<NormalisedVolume> volume = source.inMemory();
  if (!volume) {
    return {positions(source.dims(), seed, voxels), {}};
  }
  const VoxelDraw draw(*volume, arena);
  const std::uint64_t stream = StreamSeed(seed, RandomStream::Estimate);
  Choice choice{std::vector<glm::vec3>(static_cast<std::size_t>(voxels)),
                std::vector<float>(static_cast<std::size_t>(voxels))};
  arena.forEachBlock(voxels, TaskSize, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const VoxelDraw::Voxel voxel = draw.voxel(stream, static_cast<std::uint64_t>(k));
      choice.positions[k] = (glm::dvec3(voxel.at) + 0.5) / glm::dvec3(source.dims());
      choice.weights[k] = voxel.weight;
    }
  });
  return choice;
}

PsnrEstimate::PsnrEstimate(Choice choice, std::vector<float> targets, const Arena& arena)
    : Threads(arena), Positions(std::move(choice.positions)), Weights(std::move(choice.weights)),
      Targets(std::move(targets)),
      Known(std::count_if(this->Targets.begin(), this->Targets.end(),
                          [](float target) { return std::isfinite(target); }))
{}

PsnrEstimate::PsnrEstimate(const Choice& choice, const SampleSource& source, const Arena& arena)
    : PsnrEstimate(choice, TargetsAt(source, choice.positions), arena)
{}

PsnrEstimate::PsnrEstimate(const SampleSource& source, std::uint64_t seed, const Arena& arena,
                           std::int64_t voxels)
    : PsnrEstimate(Choose(source, seed, arena, voxels), source, arena)
{}

PsnrEstimate::PsnrEstimate(std::vector<glm::vec3> positions, std::vector<float> targets,
                           const Arena& arena)
    : PsnrEstimate(Choice{std::move(positions), {}}, std::move(targets), arena)
{}

PsnrEstimate PsnrEstimate::first(std::int64_t voxels) const
{
  Choice choice{{this->Positions.begin(), this->Positions.begin() + voxels}, {}};
  if (!this->Weights.empty()) {
    choice.weights.assign(this->Weights.begin(), this->Weights.begin() + voxels);
  }
  return {
      std::move(choice), {this->Targets.begin(), this->Targets.begin() + voxels}, this->Threads};
}

double PsnrEstimate::measure(const ModelView& model, const EvaluateKernel& kernel,
                             const StopCheck& check) const
{
  const double squared = this->squaredError(this->values(model, kernel, check));
  return check.goesOn() && this->Known > 0 ? -10.0 * std::log10(squared) : 0.0;
}

std::vector<float> PsnrEstimate::values(const ModelView& model, const EvaluateKernel& kernel,
                                        const StopCheck& check) const
{
  const PackedNetwork network(model);
  std::vector<float> values(this->Targets.size());
  this->Threads.forEachBlock(static_cast<std::int64_t>(values.size()), TaskSize,
                             [&](std::int64_t begin, std::int64_t end) {
                               this->evaluate(network.view(), kernel, check, begin, end,
                                              values.data());
                             });
  return values;
}

void PsnrEstimate::evaluate(const ModelView& model, const EvaluateKernel& kernel,
                            const StopCheck& check, std::int64_t begin, std::int64_t end,
                            float* values) const
{
  std::vector<float> workspace(static_cast<std::size_t>(kernel.workspace(model)));
  for (std::int64_t first = begin; first < end && check.goesOn(); first += BlockSize) {
    kernel.evaluate(model, &this->Positions[first].x, std::min(BlockSize, end - first),
                    values + first, workspace.data());
  }
  std::transform(values + begin, values + end, values + begin, NormalisedOutput);
}

bool PsnrEstimate::isStuck(const ModelView& model, const EvaluateKernel& kernel,
                           const StopCheck& check) const
{
  if (!(this->squaredErrorOfConstant() > 0)) {
    return false;
  }
  const PackedNetwork network(model);
  std::vector<float> workspace(static_cast<std::size_t>(kernel.workspace(network.view())));
  std::vector<float> values(BlockSize);
  std::optional<float> first;
  for (std::int64_t begin = 0; begin < this->voxels(); begin += BlockSize) {
    const std::int64_t count = std::min(BlockSize, this->voxels() - begin);
    kernel.evaluate(network.view(), &this->Positions[begin].x, count, values.data(),
                    workspace.data());
    first = first.value_or(values.front());
    if (!check.goesOn() || std::any_of(values.begin(), values.begin() + count,
                                       [&](float value) { return value != *first; })) {
      return false; // at once, as of all others
    }
  }
  return true;
}

std::uint32_t PsnrEstimate::checksum() const
{
  return ContinueChecksum(0, this->Targets.data(), this->Targets.size() * sizeof(float));
}

double PsnrEstimate::squaredError(const std::vector<float>& values) const
{
  double squared = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isfinite(this->Targets[k])) {
      const double difference = values[k] - this->Targets[k];
      squared += this->weight(k) * difference * difference;
    }
  }
  return squared / static_cast<double>(std::max<std::int64_t>(1, this->Known));
}

double PsnrEstimate::squaredErrorOfConstant() const
{
  double sum = 0;
  double weights = 0;
  for (std::size_t k = 0; k < this->Targets.size(); ++k) {
    if (std::isfinite(this->Targets[k])) {
      sum += this->weight(k) * this->Targets[k];
      weights += this->weight(k);
    }
  }
  const double mean = weights > 0 ? sum / weights : 0;
  return this->squaredError(std::vector<float>(this->Targets.size(), static_cast<float>(mean)));
}

double PsnrEstimate::squaredDifference(const std::vector<float>& a,
                                       const std::vector<float>& b) const
{
  double squared = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double difference = a[k] - b[k];
    squared += this->weight(k) * difference * difference;
  }
  return squared / static_cast<double>(a.size());
}

} // namespace inr
