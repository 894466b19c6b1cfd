// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame's rays share, from the host's memory into a machine's.
#pragma once

#include "CUDA/Render/DeviceColors.h"
#include "CUDA/Render/Kernels/RenderScene.h"
#include "Core/Render/AcceleratedRenderer.h"

#include <cstdint>
#include <vector>

namespace inr {
namespace cuda {

/// A frame's rays. `arrays` must outlive them.
template <class Machine>
RayView RaysOn(Machine& machine, const RayView& given, Belongings<Machine>& arrays)
{
  const std::int64_t pixels = std::int64_t{given.width} * given.height;
  RayView rays = given;
  rays.opaqueDepth = arrays.put(machine, given.opaqueDepth, pixels);
  rays.planes = arrays.put(machine, given.planes, given.planeCount);
  rays.piece = arrays.put(machine, given.piece, given.pieceCount);
  std::vector<SurfaceLayer> layers;
  for (int k = 0; k < given.layers.count; ++k) {
    const SurfaceLayer& layer = given.layers.layers[k];
    layers.push_back(
        {arrays.put(machine, layer.depth, pixels), arrays.put(machine, layer.colors, pixels)});
  }
  rays.layers.layers = arrays.put(machine, layers.data(), given.layers.count);
  return rays;
}

/// Of rays that are marched, but for the table of steps. `arrays` must outlive the scene.
template <class Machine>
RenderScene SceneOn(Machine& machine, const MarchJob& job, const DeviceColors<Machine>& colors,
                    Belongings<Machine>& arrays)
{
  const Frame& frame = job.frame;
  RenderScene scene{};
  scene.rays = RaysOn(machine, job.geometry.view(), arrays);
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
  scene.rays = RaysOn(machine, given.rays, arrays);
  scene.inner =
      given.inner.with(arrays.put(machine, given.inner.planes(), given.inner.planeCount()));
  scene.majorants = colors.majorants();
  scene.colors = colors.lookup();
  scene.lights = arrays.put(machine, given.lights, given.lightCount);
  return scene;
}

} // namespace cuda
} // namespace inr
