// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/CudaTrainer.h"

#include "CUDA/Training/StartTraining.h"

#include <utility>

namespace inr {
namespace cuda {

namespace {

class CudaTrainer : public TrainingAccelerator
{
public:
  explicit CudaTrainer(Device device) : Where(std::move(device)) {}

  std::string name() const override { return "CUDA float32, " + this->Where.name; }
  std::string kernel() const override { return "cuda float32"; }
  std::unique_ptr<AcceleratedTraining> start(const TrainingTask& task) const override
  {
    return StartTraining(this->Where, task);
  }

private:
  Device Where;
};

} // namespace

std::shared_ptr<const TrainingAccelerator> MakeTrainer(const Device& device)
{
  return std::make_shared<CudaTrainer>(device);
}

FoundTrainer FindTrainer(int localRank)
{
  const Devices devices = FindDevices();
  const Device* const device = devices.of(localRank);
  return device != nullptr ? FoundTrainer{MakeTrainer(*device), ""}
                           : FoundTrainer{nullptr, devices.reason};
}

} // namespace cuda
} // namespace inr
