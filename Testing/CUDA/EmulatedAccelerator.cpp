// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/CUDA/EmulatedAccelerator.h"

#include "Testing/CUDA/EmulatedRenderers.h"
#include "Testing/CUDA/HostMachine.h"

std::shared_ptr<inr::AcceleratedRenderer>
EmulatedAccelerator::makeRenderer(const inr::ModelPointer& model, const glm::i64vec3& dims,
                                  const inr::CacheOptions& options) const
{
  if (this->Does == Duty::Infers) {
    return nullptr;
  }
  inr::CacheOptions own = options;
  own.bytes = this->Bytes > 0 ? this->Bytes : options.bytes;
  return MakeRendererOn<HostMachine>(this->Launch, this->inferenceOf(model), dims, own,
                                     this->Shares);
}

std::shared_ptr<inr::AcceleratedRenderer>
EmulatedAccelerator::makeNetworkRenderer(const inr::ModelPointer& model) const
{
  if (this->Does == Duty::Infers) {
    return nullptr;
  }
  return MakeNetworkRendererOn<HostMachine>(this->Launch, this->inferenceOf(model));
}
