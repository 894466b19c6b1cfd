// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace inr {

/// What surfaces that let light through do to the light behind them: `color` comes on top, and
/// `passes` of it gets past.
struct Veil
{
  glm::vec3 color{0.0f};
  float passes = 1;

  /// Puts a surface of premultiplied colour and opacity behind the others.
  void addBehind(const glm::vec4& surface)
  {
    this->color += this->passes * glm::vec3(surface);
    this->passes *= 1.0f - surface.w;
  }
};

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

    bool operator==(const Layer& other) const
    {
      return this->depth == other.depth && this->colors == other.colors;
    }
  };
  std::vector<Layer> layers;

  int count() const { return static_cast<int>(this->layers.size()); }
  /// Window-space depth of a layer; 1 where there is none.
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
  /// All that is in front of a window-space depth.
  Veil inFrontOf(double windowDepth, std::size_t pixel) const;
};

/// What a ray has gathered that goes from layer to layer: the volume's light as it comes through.
class LayeredLight
{
public:
  /// Takes in what the ray has gathered since the last call: all so far is `color`, premultiplied
  /// light of the volume alone, and `transmittance`.
  void gather(const glm::vec3& color, float transmittance)
  {
    this->Seen += this->Front.passes * (color - this->Color) +
                  (this->Transmittance - transmittance) * this->Front.color;
    this->Color = color;
    this->Transmittance = transmittance;
  }
  /// Goes on behind a surface.
  void pass(const glm::vec4& surface) { this->Front.addBehind(surface); }
  /// How much of the light further behind is seen.
  float passes() const { return this->Front.passes; }
  const glm::vec3& seen() const { return this->Seen; }

private:
  Veil Front;
  glm::vec3 Seen{0.0f};
  glm::vec3 Color{0.0f};
  float Transmittance = 1;
};

} // namespace inr
