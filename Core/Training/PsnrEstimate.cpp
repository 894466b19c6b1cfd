// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/PsnrEstimate.h"

#include "Core/Model/Model.h"
#include "Core/Random.h"

#include <cmath>

namespace inr {

namespace {
constexpr std::int64_t SampleCount = 1 << 15;
constexpr std::int64_t BlockSize = 64;
constexpr std::uint64_t EstimateStream = 3; // apart from those of GradientDescent
} // namespace

PsnrEstimate::PsnrEstimate(const SampleSource& source, std::uint64_t seed)
    : Positions(SampleCount), Targets(SampleCount)
{
  const std::uint64_t stream = RandomBits(seed, EstimateStream);
  for (std::int64_t k = 0; k < SampleCount; ++k) {
    this->Positions[k] = RandomPosition(stream, static_cast<std::uint64_t>(k), source.dims());
  }
  source.sample(this->Positions.data(), SampleCount, this->Targets.data());
}

double PsnrEstimate::measure(const ModelView& model, const EvaluateKernel& kernel,
                             const StopCheck& check) const
{
  const PackedNetwork network(model);
  std::vector<float> values(SampleCount);
  std::vector<float> workspace(static_cast<std::size_t>(kernel.workspace(network.view())));
  for (std::int64_t first = 0; first < SampleCount; first += BlockSize) {
    if (!check.goesOn()) {
      return 0.0;
    }
    kernel.evaluate(network.view(), &this->Positions[first].x, BlockSize, &values[first],
                    workspace.data());
  }
  double squared = 0;
  std::int64_t finite = 0;
  for (std::int64_t k = 0; k < SampleCount; ++k) {
    if (std::isfinite(this->Targets[k])) {
      const double difference = NormalisedOutput(values[k]) - this->Targets[k];
      squared += difference * difference;
      ++finite;
    }
  }
  return finite > 0 ? -10.0 * std::log10(squared / static_cast<double>(finite)) : 0.0;
}

} // namespace inr
