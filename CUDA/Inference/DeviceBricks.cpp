// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Slots.h"
#include "CUDA/Inference/BrickBatch.h"
#include "CUDA/Inference/DeviceModel.h"
#include "CUDA/Inference/Overflow.h"

#include <algorithm>
#include <mutex>
#include <utility>

namespace inr {
namespace cuda {

namespace {

/// Bricks of a launch: 16 MiB of voxels, so that there is work for every multiprocessor.
std::int64_t BricksPerPiece(const Hierarchy& levels)
{
  constexpr std::int64_t voxels = 4 << 20;
  return std::clamp<std::int64_t>(voxels / levels.voxelsPerBrick(), 1, 1024);
}

class DeviceBricks : public BrickSource
{
public:
  DeviceBricks(std::shared_ptr<const DeviceModel> model, const Hierarchy& levels)
      : BrickSource(levels), Uploaded(std::move(model)),
        Core(inr::MakeBrickSource(inr::MakeEvaluator(this->Uploaded->source()), levels)),
        Plan(this->Uploaded->plan(true)), Piece(BricksPerPiece(levels)),
        Slots(MakeSlots<BrickJob>(this->Uploaded->device().ordinal, this->Piece,
                                  this->Piece * levels.voxelsPerBrick(), this->Plan.scratch))
  {}

  /// As many as give each of a large GPU's multiprocessors something to do several times over.
  std::int64_t bricksAtOnce() const override { return std::min<std::int64_t>(this->Piece, 16); }

  void inferLayer(BrickKey key, std::int64_t z, float* values) const override
  {
    this->inferLayers(&key, 1, z, 1, values);
  }

  void infer(const BrickKey* keys, std::int64_t count, float* values, const Arena&) const override
  {
    this->inferLayers(keys, count, 0, this->hierarchy().brickDims().z, values);
  }

private:
  /// The same layers of all bricks.
  void inferLayers(const BrickKey* keys, std::int64_t count, std::int64_t z, std::int64_t layers,
                   float* values) const
  {
    const Hierarchy& levels = this->hierarchy();
    const std::int64_t voxels = levels.voxelsPerBrick() / levels.brickDims().z * layers;
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto submit = [&](const Slot<BrickJob>& slot, std::int64_t first, std::int64_t size) {
      BrickBatch batch;
      for (std::int64_t k = first; k < first + size; ++k) {
        batch.append(levels, keys[k], z, layers);
      }
      this->submit(slot, batch);
    };
    const auto collect = [&](const Slot<BrickJob>& slot, std::int64_t first, std::int64_t size) {
      std::copy_n(slot.hostOut.data(), size * voxels, values + first * voxels);
      for (std::int64_t k = first; k < first + size; ++k) {
        RepairLayers(*this->Core, keys[k], z, layers, values + k * voxels);
      }
    };
    InPieces(this->Slots, count, this->Piece, submit, collect);
  }

  void submit(const Slot<BrickJob>& slot, const BrickBatch& batch) const
  {
    const auto count = static_cast<std::int64_t>(batch.jobs.size());
    std::copy(batch.jobs.begin(), batch.jobs.end(), slot.hostIn.data());
    CopyToDevice(slot.in.data(), slot.hostIn.data(), count, slot.stream);
    this->Uploaded->inferBricks(this->Plan, slot.in.data(), count, batch.items, slot.out.data(),
                                slot.scratch.data(), slot.stream);
    CopyToHost(slot.hostOut.data(), slot.out.data(), batch.values, slot.stream);
  }

  std::shared_ptr<const DeviceModel> Uploaded;
  std::shared_ptr<const BrickSource> Core; ///< for what overflows
  LaunchPlan Plan;
  std::int64_t Piece;       ///< bricks
  mutable std::mutex Mutex; ///< guards the slots
  SlotPair<BrickJob> Slots;
};

} // namespace

std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const DeviceModel> model,
                                                   const Hierarchy& hierarchy)
{
  return std::make_shared<DeviceBricks>(std::move(model), hierarchy);
}

} // namespace cuda
} // namespace inr
