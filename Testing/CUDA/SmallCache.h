// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of more bricks than their cache on the device holds.
#pragma once

#include "CUDA/Cache/CacheLayout.h"
#include "CUDA/Inference/PackedModel.h"
#include "Testing/CUDA/DrawingScene.h"

#include <algorithm>
#include <memory>

constexpr int SmallBrick = 5; ///< of which the model has more than a hundred

/// Bytes of a device's cache that holds so many, beside what infers.
inline std::int64_t BytesFor(std::int64_t bricks, std::int64_t inference)
{
  const inr::Hierarchy levels(TrainedModel()->volume.dims, SmallBrick);
  const inr::cuda::CacheNeeds needs{
      inference, static_cast<std::int64_t>(TrainedModel()->macroCells.ranges.size())};
  std::int64_t bytes = 1000;
  while (true) {
    try {
      const auto precision = inr::CachePrecision::Bits16;
      if (inr::cuda::LayOutCache(levels, precision, bytes, needs).capacity >= bricks) {
        return bytes;
      }
    } catch (const inr::Error&) { // less than it must have
    }
    bytes += 100;
  }
}

/// What a single block of threads infers in, where that is not registers.
inline std::int64_t BytesToInferIn(const inr::cuda::Device& device)
{
  const inr::cuda::FloatTables tables(*TrainedModel(), nullptr, nullptr);
  const std::int64_t perThread =
      device.code < 80 ? inr::cuda::ScratchPerThread(tables.view(nullptr, nullptr)) : 0;
  return inr::cuda::ThreadsPerBlock * static_cast<std::int64_t>(sizeof(float)) * perThread;
}

/// With a cache for so many on the device; 0: for all.
inline inr::RendererOptions RoomFor(Place place, std::int64_t bricks, HostLaunch launch = {})
{
  inr::RendererOptions options = OptionsWith(DeviceIn(place));
  options.cache.brickSize = SmallBrick;
  if (bricks > 0 && place == Place::Gpu) { // where inferring takes something, and the CPU's is no
                                           // smaller
    options.cache.bytes =
        BytesFor(std::max<std::int64_t>(bricks, 32), BytesToInferIn(inr::cuda::ChooseDevice()));
  } else if (bricks > 0) {
    options.accelerator = std::make_shared<EmulatedAccelerator>(
        inr::cuda::Precision::Float32, Duty::InfersAndDraws, launch, BytesFor(bricks, 0));
  }
  return options;
}

/// As often as it takes.
inline inr::Image Finish(inr::Renderer& renderer, const inr::Frame& frame, int& calls)
{
  inr::Image image;
  calls = 1;
  while (!renderer.render(frame, image).complete && calls < 1000) {
    ++calls;
  }
  return image;
}
