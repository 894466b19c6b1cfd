// SPDX-License-Identifier: BSD-3-Clause
//
// What makes renderers of the kernels on a machine. Takes long to compile: only for sources that
// have a machine of their own.
#pragma once

#include "CUDA/Cache/DeviceCache.h"
#include "CUDA/Render/DeviceRenderer.h"
#include "CUDA/Render/NetworkRenderer.h"
#include "Testing/CUDA/EmulatedInference.h"

#include <memory>
#include <utility>

/// `where`: of what the machine is made. `shares`: with whom its memory is shared.
template <class Machine, class Where>
std::shared_ptr<inr::AcceleratedRenderer>
MakeRendererOn(const Where& where, EmulatedInference inference, const glm::i64vec3& dims,
               const inr::CacheOptions& options,
               const std::shared_ptr<inr::cuda::CacheShares>& shares =
                   std::make_shared<inr::cuda::CacheShares>())
{
  using Cache = inr::cuda::DeviceCache<Machine, EmulatedInference>;
  const inr::ModelPointer model = inference.source();
  auto store = inr::cuda::MakeSharingStore<Machine, Cache>(
      shares, where, std::move(inference),
      inr::Hierarchy(dims, options.brickSize, inr::ResolutionOf(*model)), options.precision,
      options.bytes, model->macroCells);
  return std::make_shared<inr::cuda::DeviceRenderer<Machine, Cache>>(std::move(store), options);
}

template <class Machine, class Where>
std::shared_ptr<inr::AcceleratedRenderer>
MakeNetworkRendererOn(const Where& where, EmulatedInference inference,
                      const inr::cuda::WaveSizes& sizes = {})
{
  return std::make_shared<inr::cuda::NetworkRenderer<Machine, EmulatedInference>>(
      where, std::move(inference), sizes);
}
