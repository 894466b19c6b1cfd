// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame's rays share, from the host's memory into a machine's.
#pragma once

#include "CUDA/Render/DeviceColors.h"
#include "CUDA/Render/Kernels/RenderScene.h"
#include "Core/Render/AcceleratedRenderer.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Of rays that are marched, but for the table of steps. `arrays` must outlive the scene.
template <class Machine>
RenderScene SceneOn(Machine& machine, const MarchJob& job, const DeviceColors<Machine>& colors,
                    Belongings<Machine>& arrays)
{
  const Frame& frame = job.frame;
  RenderScene scene{};
  scene.rays = job.geometry.view();
  scene.rays.opaqueDepth =
      arrays.put(machine, frame.opaqueDepth, std::int64_t{frame.width} * frame.height);
  scene.rays.planes = arrays.put(machine, scene.rays.planes, scene.rays.planeCount);
  scene.rays.piece = arrays.put(machine, scene.rays.piece, scene.rays.pieceCount);
  scene.streams = StreamsOf(frame);
  scene.majorants = colors.majorants();
  scene.colors = colors.lookup();
  scene.settings = job.settings;
  scene.levelOfDetailScale = frame.levelOfDetailScale;
  scene.lit = job.shading != nullptr;
  if (scene.lit) {
    scene.shading = job.shading->view();
    scene.shading.lights = arrays.put(machine, scene.shading.lights, scene.shading.lightCount);
    scene.shading.constant =
        arrays.put(machine, scene.shading.constant, scene.shading.constantCount);
  }
  return scene;
}

/// Of paths.
template <class Machine>
PathScene SceneOn(Machine& machine, const PathScene& given, const DeviceColors<Machine>& colors,
                  Belongings<Machine>& arrays)
{
  PathScene scene = given;
  const std::int64_t pixels = std::int64_t{given.rays.width} * given.rays.height;
  scene.rays.opaqueDepth = arrays.put(machine, given.rays.opaqueDepth, pixels);
  scene.rays.planes = arrays.put(machine, given.rays.planes, given.rays.planeCount);
  scene.rays.piece = arrays.put(machine, given.rays.piece, given.rays.pieceCount);
  scene.inner =
      given.inner.with(arrays.put(machine, given.inner.planes(), given.inner.planeCount()));
  scene.majorants = colors.majorants();
  scene.colors = colors.lookup();
  scene.lights = arrays.put(machine, given.lights, given.lightCount);
  return scene;
}

} // namespace cuda
} // namespace inr
