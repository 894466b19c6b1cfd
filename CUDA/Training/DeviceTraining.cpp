// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Machine.h"
#include "CUDA/Training/MachineTraining.h"
#include "CUDA/Training/StartTraining.h"

namespace inr {
namespace cuda {

std::unique_ptr<AcceleratedTraining> StartTraining(const Device& device, const TrainingTask& task)
{
  const TrainingPlan plan(task, FreeMemory(device.ordinal));
  return std::make_unique<MachineTraining<GpuMachine>>(std::make_unique<GpuMachine>(device.ordinal),
                                                       task, plan);
}

} // namespace cuda
} // namespace inr
