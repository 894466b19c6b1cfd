// SPDX-License-Identifier: BSD-3-Clause
//
// A model's kernels for a DeviceCache and a DeviceWave, run on the host.
#pragma once

#include "Testing/CUDA/Emulated.h"
#include "Testing/CUDA/HostMachine.h"

#include <memory>
#include <utility>

class EmulatedInference
{
public:
  explicit EmulatedInference(std::shared_ptr<const EmulatedModel> model) : Model(std::move(model))
  {}

  const inr::ModelPointer& source() const { return this->Model->source(); }
  std::int64_t bytes() const { return 0; } // what it takes is not the machine's

  void infer(const HostMachine& /*machine*/, const inr::cuda::BrickJob* jobs,
             const inr::cuda::BrickEnd* end, float* values) const
  {
    this->Model->inferBricks(jobs, end, values);
  }
  void infer(const HostMachine& /*machine*/, const float* positions, const std::uint64_t* count,
             float* values) const
  {
    this->Model->inferPoints(positions, count, values);
  }

private:
  std::shared_ptr<const EmulatedModel> Model;
};
