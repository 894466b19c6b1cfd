// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Device.h"
#include "CUDA/Inference/Precision.h"
#include "Core/Render/Acceleration/Accelerator.h"

#include <memory>
#include <string>

namespace inr {
namespace cuda {

/// A GPU for renderers. Float32 is what keeps their pictures: half precision is off by up to 1e-3,
/// many times the quantum of the cache's 16 bits.
std::shared_ptr<const Accelerator> MakeAccelerator(const Device& device,
                                                   Precision precision = Precision::Float32);

/// What is to be had for renderers.
struct FoundAccelerator
{
  std::shared_ptr<const Accelerator> accelerator; ///< may be null
  std::string reason;                             ///< why it is
};
/// That of the GPU of the `localRank`-th process on this machine: the same one for all of this
/// process as long as somebody has it and it works. Never throws for want of a GPU.
FoundAccelerator FindAccelerator(int localRank);

} // namespace cuda
} // namespace inr
