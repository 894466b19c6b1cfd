// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Lanes.h.
#include "Core/Inference/EvaluateKernel.h"

#include "Core/Inference/Encode.h"
#include "Core/Inference/Network.h"

namespace inr {
namespace INR_ISA {

namespace {

std::int64_t Workspace(const ModelView& model) { return StripWorkspace(model); }

void EvaluateAll(const ModelView& model, const float* xyz, std::int64_t count, float* values,
                 float* workspace)
{
  StripPair strips = MakeStrips(model, workspace);
  for (std::int64_t first = 0; first < count; first += StripSize) {
    const std::int64_t left = count - first;
    const int samples = left < StripSize ? static_cast<int>(left) : StripSize;
    EncodeBlock(model, xyz + 3 * first, samples, strips.in.values, StripSize);
    float outputs[StripSize];
    RunStrip(model, strips, samples, outputs);
    std::memcpy(values + first, outputs, static_cast<std::size_t>(samples) * sizeof(float));
  }
}

} // namespace

const EvaluateKernel Evaluate = {Workspace, EvaluateAll};

} // namespace INR_ISA
} // namespace inr
