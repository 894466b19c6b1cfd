// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/PsnrEstimate.h"

#include "Core/Model/Model.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Training/HalvedCube.h"
#include "Core/Training/RandomStream.h"

#include <algorithm>
#include <cmath>

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

PsnrEstimate::PsnrEstimate(std::vector<glm::vec3> positions, std::vector<float> targets,
                           const Arena& arena)
    : Threads(arena), Positions(std::move(positions)), Targets(std::move(targets)),
      Known(std::count_if(this->Targets.begin(), this->Targets.end(),
                          [](float target) { return std::isfinite(target); }))
{}

PsnrEstimate::PsnrEstimate(const SampleSource& source, std::uint64_t seed, const Arena& arena,
                           std::int64_t voxels)
    : PsnrEstimate(positions(source.dims(), seed, voxels),
                   TargetsAt(source, positions(source.dims(), seed, voxels)), arena)
{}

PsnrEstimate PsnrEstimate::first(std::int64_t voxels) const
{
  return {{this->Positions.begin(), this->Positions.begin() + voxels},
          {this->Targets.begin(), this->Targets.begin() + voxels},
          this->Threads};
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
      squared += difference * difference;
    }
  }
  return squared / static_cast<double>(std::max<std::int64_t>(1, this->Known));
}

} // namespace inr
