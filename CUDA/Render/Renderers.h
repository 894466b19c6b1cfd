// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Inference/UploadedModel.h"
#include "Core/Render/Acceleration/AcceleratedRenderer.h"
#include "Core/Render/CachedRenderer.h"

#include <memory>

namespace inr {
namespace cuda {

/// The caches of a model's renderers; they may be used on several threads.
class DeviceStores;

std::shared_ptr<DeviceStores> MakeStores();

/// What draws pictures of the model, shown with so many voxels: cache, rays and paths are on the
/// GPU. Renderers that could share a cache in `stores`, which are this model's, do. Throws
/// Error(Device) where the GPU fails or has too little memory.
std::shared_ptr<AcceleratedRenderer> MakeRenderer(const std::shared_ptr<const DeviceModel>& model,
                                                  DeviceStores& stores, const glm::i64vec3& dims,
                                                  const CacheOptions& options);
/// The same straight from its network.
std::shared_ptr<AcceleratedRenderer>
MakeNetworkRenderer(const std::shared_ptr<const DeviceModel>& model);

} // namespace cuda
} // namespace inr
