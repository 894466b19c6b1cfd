// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Lanes.h.
#include "Core/Inference/EvaluateKernel.h"

#include "Core/Inference/Encode.h"
#include "Core/Inference/Network.h"
#include "Core/Inference/Prefetch.h"

namespace inr {
namespace INR_ISA {

namespace {

std::int64_t Workspace(const ModelView& model) { return StripWorkspace(model); }

void EvaluateAll(const ModelView& model, const float* xyz, std::int64_t count, float* values,
                 float* workspace)
{
  const Batch batch;
  StripPair strips = MakeStrips(model, workspace);
  constexpr int groups = StripSize / LaneCount;
  const int tiles = HiddenTiles(model);
  const int units = HasFarLevels(model) ? model.levelCount * groups : 0;
  for (std::int64_t first = 0; first < count; first += StripSize) {
    const std::int64_t left = count - first;
    const int samples = left < StripSize ? static_cast<int>(left) : StripSize;
    EncodeBlock(model, xyz + 3 * first, samples, strips.in.values, StripSize);
    const float* const next = xyz + 3 * (first + samples);
    auto fetch = [&](int unit) {
      PrefetchGroup(model, unit / groups, next, left - samples, unit % groups * LaneCount);
    };
    Evenly between(fetch, left > samples ? units : 0, tiles);
    float outputs[StripSize];
    RunStrip(model, strips, samples, outputs, between);
    std::memcpy(values + first, outputs, static_cast<std::size_t>(samples) * sizeof(float));
  }
}

} // namespace

const EvaluateKernel Evaluate = {Workspace, EvaluateAll};

} // namespace INR_ISA
} // namespace inr
