// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/EvaluateKernel.h"
#include "Core/Training/SampleSource.h"
#include "Core/Training/StopCheck.h"

#include <cstdint>
#include <vector>

namespace inr {

/// PSNR of a network in training, on a fixed set of random positions that training does not draw.
class PsnrEstimate
{
public:
  PsnrEstimate(const SampleSource& source, std::uint64_t seed);

  /// In dB, peak 1; infinity for a perfect fit, 0 when `check` stopped it.
  double measure(const ModelView& model, const EvaluateKernel& kernel,
                 const StopCheck& check) const;

private:
  std::vector<glm::vec3> Positions;
  std::vector<float> Targets;
};

} // namespace inr
