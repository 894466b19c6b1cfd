// SPDX-License-Identifier: BSD-3-Clause
//
// What takes the place of the GPU's part in a build without a CUDA compiler.
#include "CUDA/Render/Renderers.h"
#include "CUDA/Training/StartTraining.h"
#include "Core/Error.h"

namespace inr {
namespace cuda {

namespace {

constexpr const char* Reason = "this build has no CUDA part: it was configured without nvcc";

[[noreturn]] void Refuse() { throw Error(ErrorCode::Device, Reason); }

} // namespace

Devices FindDevices() { return {{}, Reason}; }

std::shared_ptr<const DeviceModel> UploadModel(ModelPointer, const Device&, Precision) { Refuse(); }

std::shared_ptr<const Evaluator> MakeEvaluator(std::shared_ptr<const DeviceModel>) { Refuse(); }

std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const DeviceModel>,
                                                   const Hierarchy&)
{
  Refuse();
}

std::shared_ptr<DeviceStores> MakeStores() { Refuse(); }

std::shared_ptr<AcceleratedRenderer> MakeRenderer(const std::shared_ptr<const DeviceModel>&,
                                                  DeviceStores&, const glm::i64vec3&,
                                                  const CacheOptions&)
{
  Refuse();
}

std::shared_ptr<AcceleratedRenderer> MakeNetworkRenderer(const std::shared_ptr<const DeviceModel>&)
{
  Refuse();
}

std::unique_ptr<AcceleratedTraining> StartTraining(const Device&, const TrainingTask&) { Refuse(); }

} // namespace cuda
} // namespace inr
