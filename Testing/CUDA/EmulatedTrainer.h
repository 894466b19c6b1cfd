// SPDX-License-Identifier: BSD-3-Clause
//
// The GPU's trainer, run on the host.
#pragma once

#include "CUDA/Training/MachineTraining.h"
#include "Core/Training/Descent/TrainingAccelerator.h"
#include "Testing/CUDA/HostMachine.h"

#include <functional>
#include <limits>
#include <memory>
#include <string>

/// `Machine`: HostMachine or LazyMachine.
template <class Machine> class TrainerOn : public inr::TrainingAccelerator
{
public:
  /// With so many bytes of memory that may be taken.
  explicit TrainerOn(std::int64_t memory = std::numeric_limits<std::int64_t>::max(),
                     HostLaunch launch = {})
      : Memory(memory), Launch(launch)
  {}

  std::string name() const override { return "CUDA, emulated"; }
  std::string kernel() const override { return "cuda float32"; }
  std::unique_ptr<inr::AcceleratedTraining> start(const inr::TrainingTask& task) const override
  {
    inr::cuda::TrainingPlan plan(task, this->Memory);
    if (this->change) {
      this->change(plan);
    }
    return std::make_unique<inr::cuda::MachineTraining<Machine>>(
        std::make_unique<Machine>(this->Launch), task, plan);
  }

  std::function<void(inr::cuda::TrainingPlan&)> change; ///< of what is planned

private:
  std::int64_t Memory;
  HostLaunch Launch;
};

using EmulatedTrainer = TrainerOn<HostMachine>;
