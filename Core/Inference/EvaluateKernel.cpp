// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Lanes.h.
#include "Core/Inference/EvaluateKernel.h"

#include "Core/Inference/Encode.h"
#include "Core/Inference/Network.h"

namespace inr {
namespace INR_ISA {

namespace {

/// Samples that go through the network together: two layers of them stay in the first-level cache.
constexpr std::int64_t BlockSize = 64;

std::int64_t Workspace(const ModelView& model) { return 2 * BlockSize * model.widest; }

void EvaluateBlock(const ModelView& model, const float* xyz, std::int64_t count, float* values,
                   float* workspace)
{
  const std::int64_t samples = (count + LaneCount - 1) / LaneCount * LaneCount;
  float* in = workspace;
  float* out = workspace + BlockSize * model.widest;
  EncodeBlock(model, xyz, count, in, BlockSize);
  const float* const outputs = RunNetwork(model, in, out, BlockSize, samples);
  std::memcpy(values, outputs, static_cast<std::size_t>(count) * sizeof(float));
}

void EvaluateAll(const ModelView& model, const float* xyz, std::int64_t count, float* values,
                 float* workspace)
{
  for (std::int64_t first = 0; first < count; first += BlockSize) {
    const std::int64_t block = count - first < BlockSize ? count - first : BlockSize;
    EvaluateBlock(model, xyz + 3 * first, block, values + first, workspace);
  }
}

} // namespace

const EvaluateKernel Evaluate = {Workspace, EvaluateAll};

} // namespace INR_ISA
} // namespace inr
