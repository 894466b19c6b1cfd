// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/PlannedModel.h"

#include <algorithm>
#include <utility>

namespace inr {
namespace cuda {

namespace {

constexpr auto FloatBytes = static_cast<std::int64_t>(sizeof(float));

LaunchPlan PlanWithin(const DeviceModel& model, bool bricks, std::int64_t bytes)
{
  LaunchPlan plan = model.plan(bricks);
  const std::int64_t perBlock = plan.scratch / plan.blocks;
  if (perBlock > 0) {
    plan.blocks = std::clamp<std::int64_t>(bytes / FloatBytes / perBlock, 1, plan.blocks);
    plan.scratch = plan.blocks * perBlock;
  }
  return plan;
}

} // namespace

PlannedModel::PlannedModel(std::shared_ptr<const DeviceModel> model, bool bricks,
                           std::int64_t bytes)
    : Uploaded(std::move(model)), Plan(PlanWithin(*this->Uploaded, bricks, bytes)),
      Scratch(this->Uploaded->device().ordinal, Memory::Place::Device,
              std::max<std::int64_t>(this->Plan.scratch, 1))
{}

std::int64_t PlannedModel::bytes() const { return this->Scratch.size() * FloatBytes; }

} // namespace cuda
} // namespace inr
