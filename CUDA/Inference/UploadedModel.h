// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Device.h"
#include "CUDA/Inference/Precision.h"
#include "Core/Cache/BrickSource.h"
#include "Core/Inference/Evaluator.h"

#include <memory>

namespace inr {
namespace cuda {

/// A model in a GPU's memory. Immutable: any number of evaluators may use one at once.
class DeviceModel;

/// Copies a model to a GPU. Throws Error(Device) with figures where its memory is short or the GPU
/// fails, and what PackedModel throws.
std::shared_ptr<const DeviceModel> UploadModel(ModelPointer model, const Device& device,
                                               Precision precision);

/// Values at points. Calls from several threads take turns; batches of 2^15 points and more keep
/// the GPU busy. What the kernels cannot hold, Core's evaluator computes: values are always finite.
/// Throws Error(Device) where the GPU fails; it is of no use any more then.
std::shared_ptr<const Evaluator> MakeEvaluator(std::shared_ptr<const DeviceModel> model);

/// Voxels of bricks, best by BrickSource::infer and many bricks at once, on streams of their own.
/// The same otherwise.
std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const DeviceModel> model,
                                                   const Hierarchy& hierarchy);

} // namespace cuda
} // namespace inr
