// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Frame.h"
#include "Core/Render/LayersView.h"
#include "Core/Render/TranslucentLayers.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace inr {
namespace cuda {

/// Translucent layers in a machine's memory.
template <class Machine> class DeviceLayers
{
public:
  DeviceLayers(Machine& machine, const TranslucentLayers& layers, std::int64_t pixels)
      : Depths(machine.template allocate<float>(layers.count() * pixels)),
        Colors(machine.template allocate<glm::vec4>(layers.count() * pixels)),
        List(machine.template allocate<SurfaceLayer>(layers.count())), View{this->List.data(),
                                                                            layers.count()}
  {
    std::vector<SurfaceLayer> list;
    for (const TranslucentLayers::Layer& layer : layers.layers) {
      const std::int64_t at = static_cast<std::int64_t>(list.size()) * pixels;
      list.push_back({this->Depths.data() + at, this->Colors.data() + at});
      machine.toMachine(this->Depths.data() + at, layer.depth.data(), pixels);
      machine.toMachine(this->Colors.data() + at, layer.colors.data(), pixels);
    }
    machine.toMachine(this->List.data(), list.data(), layers.count());
  }

  const LayersView& view() const { return this->View; }

private:
  typename Machine::template Array<float> Depths;
  typename Machine::template Array<glm::vec4> Colors;
  typename Machine::template Array<SurfaceLayer> List;
  LayersView View;
};

/// Those of the latest frame that had any: a picture comes by many calls, of paths one for each
/// sample. Given up when a frame has none.
template <class Machine> class LatestLayers
{
public:
  /// A copy; null of none. Lives as long as somebody has it.
  std::shared_ptr<const DeviceLayers<Machine>> of(Machine& machine, const Frame& frame)
  {
    if (frame.layers != this->Given) {
      this->Latest.reset();
      this->Given = frame.layers;
      if (frame.layers && frame.layers->any()) {
        this->Latest = std::make_shared<const DeviceLayers<Machine>>(
            machine, *frame.layers, std::int64_t{frame.width} * frame.height);
      }
    }
    return this->Latest;
  }

private:
  std::shared_ptr<const TranslucentLayers> Given; ///< held, so that no other gets its address
  std::shared_ptr<const DeviceLayers<Machine>> Latest;
};

template <class Machine>
LayersView ViewOf(const std::shared_ptr<const DeviceLayers<Machine>>& layers)
{
  return layers ? layers->view() : LayersView();
}

/// Whether a machine is to have a frame's layers: it would be given up where they do not fit.
inline bool TakesLayersOf(const Frame& frame)
{
  constexpr std::int64_t most = std::int64_t{1} << 28; // bytes: six of 1920 x 1080 pixels
  constexpr std::int64_t bytes = sizeof(float) + sizeof(glm::vec4);
  const std::int64_t pixels = std::int64_t{frame.width} * frame.height;
  return !frame.layers || frame.layers->count() * pixels * bytes <= most;
}

} // namespace cuda
} // namespace inr
