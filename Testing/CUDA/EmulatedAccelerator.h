// SPDX-License-Identifier: BSD-3-Clause
//
// The GPU's kernels as an accelerator for renderers, run on the host.
#pragma once

#include "CUDA/Cache/CacheShares.h"
#include "Core/Render/Acceleration/Accelerator.h"
#include "Testing/CUDA/Emulated.h"
#include "Testing/CUDA/EmulatedInference.h"
#include "Testing/CUDA/HostMachine.h"

#include <cstdint>
#include <memory>
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
  /// Null where it only infers; else on a HostMachine.
  std::shared_ptr<inr::AcceleratedRenderer>
  makeRenderer(const inr::ModelPointer& model, const glm::i64vec3& dims,
               const inr::CacheOptions& options) const override;
  std::shared_ptr<inr::AcceleratedRenderer>
  makeNetworkRenderer(const inr::ModelPointer& model) const override;

protected:
  EmulatedInference inferenceOf(const inr::ModelPointer& model) const
  {
    return EmulatedInference(this->on(model));
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
  std::shared_ptr<inr::cuda::CacheShares> Shares = std::make_shared<inr::cuda::CacheShares>();
};
