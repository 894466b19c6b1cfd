// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame's rays share, from the host's memory into a machine's.
#pragma once

#include "CUDA/Render/DeviceColors.h"
#include "CUDA/Render/Kernels/RenderScene.h"
#include "Core/Render/Acceleration/AcceleratedRenderer.h"
#include "Core/Render/Marching/PreIntegratedColors.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// A frame's rays. `layers`: there already. `arrays` must outlive them.
template <class Machine>
RayView RaysOn(Machine& machine, const RayView& given, const LayersView& layers,
               Belongings<Machine>& arrays)
{
  RayView rays = given;
  rays.opaqueDepth =
      arrays.put(machine, given.opaqueDepth, std::int64_t{given.width} * given.height);
  rays.planes = arrays.put(machine, given.planes, given.planeCount);
  rays.piece = arrays.put(machine, given.piece, given.pieceCount);
  rays.layers = layers;
  return rays;
}

/// What a frame's rays look for. `colors`: there already.
template <class Machine>
MarchSettings SettingsOn(Machine& machine, const MarchSettings& given,
                         const DeviceColors<Machine>& colors, Belongings<Machine>& arrays)
{
  MarchSettings settings = given;
  settings.cellSampling =
      arrays.put(machine, given.cellSampling, colors.majorants().grid(0).count());
  SurfaceLookup& surfaces = settings.projector.surfaces;
  surfaces.values = arrays.put(machine, surfaces.values, surfaces.count);
  if (given.preIntegrated != nullptr) {
    const PreIntegratedLookup& lookup = *given.preIntegrated;
    const PreIntegratedLookup copy =
        lookup.with(colors.lookup(), arrays.put(machine, lookup.nodes(), lookup.nodeCount()));
    settings.preIntegrated = arrays.put(machine, &copy, 1);
  }
  return settings;
}

/// Of rays that are marched, but for the table of steps. `arrays` must outlive the scene.
template <class Machine>
RenderScene SceneOn(Machine& machine, const MarchJob& job, const DeviceColors<Machine>& colors,
                    const LayersView& layers, Belongings<Machine>& arrays)
{
  const Frame& frame = job.frame;
  RenderScene scene{};
  scene.rays = RaysOn(machine, job.geometry.view(), layers, arrays);
  scene.streams = StreamsOf(frame);
  scene.majorants = colors.majorants();
  scene.colors = colors.lookup();
  scene.settings = SettingsOn(machine, job.settings, colors, arrays);
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
                  const LayersView& layers, Belongings<Machine>& arrays)
{
  PathScene scene = given;
  scene.rays = RaysOn(machine, given.rays, layers, arrays);
  scene.inner =
      given.inner.with(arrays.put(machine, given.inner.planes(), given.inner.planeCount()));
  scene.majorants = colors.majorants();
  scene.colors = colors.lookup();
  scene.lights = arrays.put(machine, given.lights, given.lightCount);
  return scene;
}

} // namespace cuda
} // namespace inr
