// SPDX-License-Identifier: BSD-3-Clause
//
// The GPU's kernels as an accelerator for renderers, run on the host.
#pragma once

#include "CUDA/Cache/DeviceCache.h"
#include "CUDA/Render/DeviceRenderer.h"
#include "CUDA/Render/NetworkRenderer.h"
#include "Core/Cache/Accelerator.h"
#include "Testing/CUDA/Emulated.h"
#include "Testing/CUDA/EmulatedInference.h"
#include "Testing/CUDA/HostMachine.h"

#include <string>

/// What an accelerator does.
enum class Duty {
  Infers,        ///< bricks and samples
  InfersAndDraws ///< and pictures, too
};

class EmulatedAccelerator : public inr::Accelerator
{
public:
  explicit EmulatedAccelerator(inr::cuda::Precision precision, Duty duty = Duty::Infers,
                               HostLaunch launch = {}, std::int64_t cacheBytes = 0)
      : Kind(precision), Does(duty), Launch(launch), Bytes(cacheBytes)
  {}

  std::string name() const override { return "CUDA, emulated"; }

  std::shared_ptr<const inr::Evaluator> makeEvaluator(const inr::ModelPointer& model) const override
  {
    return std::make_shared<EmulatedEvaluator>(this->on(model));
  }
  std::shared_ptr<const inr::BrickSource>
  makeBrickSource(const inr::ModelPointer& model, const inr::Hierarchy& hierarchy) const override
  {
    return std::make_shared<EmulatedBricks>(this->on(model), hierarchy);
  }
  std::shared_ptr<inr::AcceleratedRenderer>
  makeRenderer(const inr::ModelPointer& model, const glm::i64vec3& dims,
               const inr::CacheOptions& options) const override
  {
    if (this->Does == Duty::Infers) {
      return nullptr;
    }
    return this->makeRendererOn<HostMachine>(this->Launch, model, dims, options);
  }
  std::shared_ptr<inr::AcceleratedRenderer>
  makeNetworkRenderer(const inr::ModelPointer& model) const override
  {
    if (this->Does == Duty::Infers) {
      return nullptr;
    }
    return this->makeNetworkRendererOn<HostMachine>(this->Launch, model);
  }

protected:
  /// `where`: of what the machine is made.
  template <class Machine, class Where>
  std::shared_ptr<inr::AcceleratedRenderer>
  makeRendererOn(const Where& where, const inr::ModelPointer& model, const glm::i64vec3& dims,
                 const inr::CacheOptions& options, const inr::cuda::WindowSizes& sizes = {}) const
  {
    using Cache = inr::cuda::DeviceCache<Machine, EmulatedInference>;
    auto store = std::make_shared<inr::cuda::DeviceStore<Machine, Cache>>(
        where, EmulatedInference(this->on(model)), inr::Hierarchy(dims, options.brickSize),
        options.precision, this->Bytes > 0 ? this->Bytes : options.bytes);
    return std::make_shared<inr::cuda::DeviceRenderer<Machine, Cache>>(std::move(store), options,
                                                                       sizes);
  }
  template <class Machine, class Where>
  std::shared_ptr<inr::AcceleratedRenderer>
  makeNetworkRendererOn(const Where& where, const inr::ModelPointer& model,
                        const inr::cuda::WaveSizes& sizes = {}) const
  {
    return std::make_shared<inr::cuda::NetworkRenderer<Machine, EmulatedInference>>(
        where, EmulatedInference(this->on(model)), sizes);
  }

private:
  std::shared_ptr<const EmulatedModel> on(const inr::ModelPointer& model) const
  {
    return std::make_shared<EmulatedModel>(model, this->Kind, this->Launch);
  }

  inr::cuda::Precision Kind;
  Duty Does;
  HostLaunch Launch;
  std::int64_t Bytes; ///< of its cache; 0 = as a renderer's options say
};
