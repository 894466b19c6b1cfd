// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Rays/LayersView.h"
#include "Core/Render/Scene/Frame.h"
#include "Core/Render/Scene/TranslucentLayers.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace inr {
namespace cuda {

/// A frame's translucent layers in a machine's memory. What has come is kept as long as frames have
/// the same ones: a picture takes many calls, of paths one for each sample. The memory stays for
/// the next ones, as taking and giving it back makes a GPU wait for all that it does.
template <class Machine> class DeviceLayers
{
public:
  /// Of the latest frame; nothing that reads those of the one before may be on its way. Without
  /// any, the memory is given back.
  LayersView of(Machine& machine, const Frame& frame)
  {
    if (!frame.layers || !frame.layers->any()) {
      this->clear();
    } else if (frame.layers != this->Given) {
      this->Given.reset(); // until all of it is there
      this->copy(machine, *frame.layers, std::int64_t{frame.width} * frame.height);
      this->Given = frame.layers;
    }
    return this->View;
  }

  void clear()
  {
    this->Room.reset();
    this->Given.reset();
    this->View = {};
  }

private:
  struct Arrays
  {
    Arrays(Machine& machine, std::int64_t layers, std::int64_t pixels)
        : depths(machine.template allocate<float>(layers * pixels)),
          colors(machine.template allocate<glm::vec4>(layers * pixels)),
          list(machine.template allocate<SurfaceLayer>(layers))
    {}

    typename Machine::template Array<float> depths;
    typename Machine::template Array<glm::vec4> colors;
    typename Machine::template Array<SurfaceLayer> list;
  };

  void copy(Machine& machine, const TranslucentLayers& layers, std::int64_t pixels)
  {
    const std::int64_t count = layers.count();
    if (!this->Room || this->Room->depths.size() < count * pixels ||
        this->Room->list.size() < count) {
      this->clear();
      this->Room.emplace(machine, count, pixels);
    }
    std::vector<SurfaceLayer> list;
    for (const TranslucentLayers::Layer& layer : layers.layers) {
      const std::int64_t at = static_cast<std::int64_t>(list.size()) * pixels;
      list.push_back({this->Room->depths.data() + at, this->Room->colors.data() + at});
      machine.toMachine(this->Room->depths.data() + at, layer.depth.data(), pixels);
      machine.toMachine(this->Room->colors.data() + at, layer.colors.data(), pixels);
    }
    machine.toMachine(this->Room->list.data(), list.data(), count);
    this->View = {this->Room->list.data(), layers.count()};
  }

  std::shared_ptr<const TranslucentLayers> Given; ///< held, so that no other gets its address
  std::optional<Arrays> Room;
  LayersView View;
};

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
