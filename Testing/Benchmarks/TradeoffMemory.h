// SPDX-License-Identifier: BSD-3-Clause
//
// What bench_tradeoff says about memory: which part of a renderer takes how much.
#pragma once

#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/TradeoffKnobs.h"
#include "Testing/Benchmarks/TradeoffScenes.h"

#include <cstdint>
#include <malloc.h>
#include <memory>
#include <string>

/// Bytes that this process has from the allocator and has not given back. The cache's bricks and
/// tables are not among them: it has their memory from the operating system.
inline double AllocatedBytes()
{
  const struct mallinfo2 information = mallinfo2();
  return static_cast<double>(information.uordblks + information.hblkhd);
}

/// MiB that have been allocated since the last time.
class Growth
{
public:
  double mib()
  {
    const double now = AllocatedBytes();
    const double grown = now - this->Last;
    this->Last = now;
    return grown / (1 << 20);
  }

private:
  double Last = AllocatedBytes();
};

/// From a model's file to a complete picture by default settings, what is kept: the parameters and
/// macro-cells of the file; with the renderer, parameters packed for the kernels and the ranges of
/// coarser cells; with colours, what can be seen of these; with the picture, bricks, the tables
/// that find them, and "working", which is rays, requests and buffers; and what a tolerance adds.
inline void MeasureMemory(const std::string& path, const Scene& scene)
{
  Growth growth;
  const inr::ModelPointer model = inr::ReadModel(path);
  Record record(scene.name + ", memory");
  record.add("model_mib", growth.mib());
  const inr::RendererOptions options = Cached();
  inr::Renderer renderer(model, options);
  record.add("renderer_mib", growth.mib());
  renderer.setTransferFunction(scene.function);
  record.add("colours_mib", growth.mib());
  inr::Image picture;
  renderer.render(scene.frame, picture);
  const std::int64_t side = options.cache.brickSize;
  const double bricks =
      static_cast<double>(renderer.cachedBricks()) *
      static_cast<double>(side * side * side * inr::BytesPerVoxel(options.cache.precision)) /
      (1 << 20);
  const double cache = static_cast<double>(renderer.cacheBytes()) / (1 << 20);
  record.add("bricks_mib", bricks).add("tables_mib", cache - bricks);
  record.add("working_mib", growth.mib());
  inr::Frame frame = scene.frame;
  frame.errorTolerance = 1;
  renderer.render(frame, picture);
  record.add("tolerance_mib", growth.mib());
  record.print();
}
