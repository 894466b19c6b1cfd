// SPDX-License-Identifier: BSD-3-Clause
//
// The GPU's kernels as an accelerator for renderers, run on the host.
#pragma once

#include "Core/Cache/Accelerator.h"
#include "Testing/CUDA/Emulated.h"

#include <string>

class EmulatedAccelerator : public inr::Accelerator
{
public:
  explicit EmulatedAccelerator(inr::cuda::Precision precision) : Kind(precision) {}

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

private:
  std::shared_ptr<const EmulatedModel> on(const inr::ModelPointer& model) const
  {
    return std::make_shared<EmulatedModel>(model, this->Kind, HostLaunch());
  }

  inr::cuda::Precision Kind;
};
