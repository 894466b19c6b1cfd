// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Slots.h"
#include "CUDA/Inference/DeviceModel.h"
#include "CUDA/Inference/Overflow.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <utility>

namespace inr {
namespace cuda {

namespace {

static_assert(sizeof(glm::vec3) == 3 * sizeof(float), "positions are copied as floats");

class DeviceEvaluator : public Evaluator
{
public:
  explicit DeviceEvaluator(std::shared_ptr<const DeviceModel> model)
      : Uploaded(std::move(model)), Core(inr::MakeEvaluator(this->Uploaded->source())),
        Plan(this->Uploaded->plan(false)),
        Slots(MakeSlots<float>(this->Uploaded->device().ordinal, 3 * Piece, Piece,
                               this->Plan.scratch))
  {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto submit = [&](const Slot<float>& slot, std::int64_t first, std::int64_t size) {
      this->submit(slot, positions + first, size);
    };
    const auto collect = [&](const Slot<float>& slot, std::int64_t first, std::int64_t size) {
      std::copy_n(slot.hostOut.data(), size, values + first);
      RepairPoints(*this->Core, positions + first, size, values + first);
    };
    InPieces(this->Slots, count, Piece, submit, collect);
  }

  glm::i64vec3 resolution() const override { return this->Core->resolution(); }
  std::int64_t pointsAtOnce() const override { return Piece / 4; } // which keep a GPU busy

  std::string kernel() const override { return this->Uploaded->name(); }

private:
  static constexpr std::int64_t Piece = 1 << 17; // points: 2 MiB a slot

  void submit(const Slot<float>& slot, const glm::vec3* positions, std::int64_t count) const
  {
    std::memcpy(slot.hostIn.data(), positions, static_cast<std::size_t>(count) * sizeof(glm::vec3));
    CopyToDevice(slot.in.data(), slot.hostIn.data(), 3 * count, slot.stream);
    this->Uploaded->inferPoints(this->Plan, slot.in.data(), count, slot.out.data(),
                                slot.scratch.data(), slot.stream);
    CopyToHost(slot.hostOut.data(), slot.out.data(), count, slot.stream);
  }

  std::shared_ptr<const DeviceModel> Uploaded;
  std::shared_ptr<const Evaluator> Core; ///< for what overflows
  LaunchPlan Plan;
  mutable std::mutex Mutex; ///< guards the slots
  SlotPair<float> Slots;
};

} // namespace

std::shared_ptr<const Evaluator> MakeEvaluator(std::shared_ptr<const DeviceModel> model)
{
  return std::make_shared<DeviceEvaluator>(std::move(model));
}

} // namespace cuda
} // namespace inr
