// SPDX-License-Identifier: BSD-3-Clause
//
// Adam (Kingma and Ba, "Adam", ICLR 2015): from the same gradients, Core's AdamUpdate.h gives the
// same parameters, bit for bit.
#pragma once

#include "CUDA/Training/Kernels/TrainGrid.h"
#include "Core/Training/Descent/TrainKernel.h"

#include <cmath>
#include <cstdint>

namespace inr {
namespace cuda {

/// What an update changes, of one parameter.
struct AdamPlace
{
  float& parameter;
  float& first;
  float& second;
};

INR_HOST_DEVICE inline void UpdateParameter(const AdamPlace& place, float gradient, float beta1,
                                            float epsilon, const AdamStep& step)
{
  const float first = beta1 * place.first + (1.0f - beta1) * gradient;
  const float second = step.beta2 * place.second + (1.0f - step.beta2) * gradient * gradient;
  place.parameter -= step.rate * first / (sqrtf(second) + epsilon);
  place.first = first;
  place.second = second;
}

/// Adds up what shards of samples have found of the weights' gradients, in place of the first's; a
/// thread for a weight.
struct TrainSumShards
{
  static constexpr int Threads = 128;

  float* gradients; ///< `count` of each shard, one after the other
  std::int64_t count;
  std::int64_t shards;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.threads([&](int thread) {
      const std::int64_t stride = std::int64_t{block.count()} * Threads;
      const std::int64_t begin = std::int64_t{block.index()} * Threads + thread;
      for (std::int64_t k = begin; k < this->count; k += stride) {
        float sum = 0.0f;
        INR_UNROLL_BY(16)
        for (std::int64_t shard = 0; shard < this->shards; ++shard) {
          sum += this->gradients[shard * this->count + k];
        }
        this->gradients[k] = sum;
      }
    });
  }
};

/// Weights of the network, a thread each.
struct TrainUpdateWeights
{
  static constexpr int Threads = 128;

  AdamRun run;
  std::int64_t first; ///< weight that is updated, and so are all behind it
  std::int64_t count;
  AdamStep step;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.threads([&](int thread) {
      const std::int64_t stride = std::int64_t{block.count()} * Threads;
      const std::int64_t begin = this->first + std::int64_t{block.index()} * Threads + thread;
      for (std::int64_t k = begin; k < this->count; k += stride) {
        const float gradient = this->run.gradients[k] + this->run.decay * this->run.parameters[k];
        UpdateParameter(
            {this->run.parameters[k], this->run.firstMoments[k], this->run.secondMoments[k]},
            gradient, this->run.beta1, this->run.epsilon, this->step);
      }
    });
  }
};

/// Parameters of the grid that were touched, and whose gradient is not zero; sums and marks become
/// zero. A thread for a line.
struct TrainUpdateGrid
{
  static constexpr int Threads = 128;

  AdamRun run; ///< without gradients
  std::uint64_t* sums;
  std::uint8_t* touched;
  std::uint16_t* counts; ///< how often each was updated
  std::int64_t count;
  const std::uint32_t* largest;
  std::int64_t samples;
  float learningRate;
  AdamSchedule schedule;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.threads([&](int thread) {
      const GradientUnit unit(*this->largest, this->samples);
      const std::int64_t lines = (this->count + GradientLine - 1) / GradientLine;
      const std::int64_t stride = std::int64_t{block.count()} * Threads;
      for (std::int64_t line = std::int64_t{block.index()} * Threads + thread; line < lines;
           line += stride) {
        if (this->touched[line] != 0) {
          this->touched[line] = 0;
          this->updateLine(line * GradientLine, unit);
        }
      }
    });
  }

private:
  INR_HOST_DEVICE void updateLine(std::int64_t first, const GradientUnit& unit) const
  {
    const std::int64_t end =
        first + GradientLine < this->count ? first + GradientLine : this->count;
    for (std::int64_t k = first; k < end; ++k) {
      const float gradient = unit.toGradient(this->sums[k]);
      this->sums[k] = 0;
      if (gradient == 0.0f) {
        continue;
      }
      const int after = this->counts[k] + 1;
      const auto counted =
          static_cast<std::uint16_t>(after < this->schedule.last ? after : this->schedule.last);
      this->counts[k] = counted;
      AdamStep step = this->schedule.steps[counted];
      step.rate = this->learningRate * step.rate;
      UpdateParameter(
          {this->run.parameters[k], this->run.firstMoments[k], this->run.secondMoments[k]},
          gradient, this->run.beta1, this->run.epsilon, step);
    }
  }
};

} // namespace cuda
} // namespace inr
