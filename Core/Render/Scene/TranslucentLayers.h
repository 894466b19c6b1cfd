// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace inr {

/// The translucent surfaces of a scene as the rays of a picture meet them, one after another.
///
/// A picture of the volume made with them is for laying over one that shows the surfaces already,
/// wherever they are: light of the volume comes through those in front of it, and what the volume's
/// opacity then takes from them, though they are in front, is in the picture to make up for it. So
///   (picture with layers) over (surfaces over rest) = surfaces and volume, in order, over rest.
struct TranslucentLayers
{
  /// At each of the picture's pixels one surface, behind those of the layers before.
  struct Layer
  {
    std::vector<float> depth;      ///< window-space, in [0, 1]; 1 = none here, nor further behind
    std::vector<glm::vec4> colors; ///< premultiplied RGBA in [0, 1]

    bool operator==(const Layer& other) const;
  };
  std::vector<Layer> layers;

  int count() const { return static_cast<int>(this->layers.size()); }
  bool any() const { return !this->layers.empty(); }
  /// See LayersView.
  float depth(int layer, std::size_t pixel) const
  {
    return layer < this->count() ? this->layers[static_cast<std::size_t>(layer)].depth[pixel]
                                 : 1.0f;
  }
  const glm::vec4& color(int layer, std::size_t pixel) const
  {
    return this->layers[static_cast<std::size_t>(layer)].colors[pixel];
  }
  /// Whether every layer has `pixels` pixels and their depths do not decrease.
  bool fits(std::int64_t pixels) const;
};

} // namespace inr
