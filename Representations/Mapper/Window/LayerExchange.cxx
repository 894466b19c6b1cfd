// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/LayerExchange.h"

#include "Representations/Mapper/Window/TranslucentPeeler.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace inr {
namespace {

/// One process' surfaces, from front to back, and how many of them each pixel has given away.
class OwnSurfaces
{
public:
  OwnSurfaces(const TranslucentLayers* layers, std::size_t pixels) : Layers(layers), Given(pixels)
  {}

  /// Window-space depth of a pixel's next one, 1 without any.
  float depth(std::size_t pixel) const
  {
    return this->Layers ? this->Layers->depth(this->Given[pixel], pixel) : 1.0f;
  }
  /// Gives it away.
  const glm::vec4& take(std::size_t pixel)
  {
    return this->Layers->color(this->Given[pixel]++, pixel);
  }
  std::size_t pixels() const { return this->Given.size(); }

private:
  const TranslucentLayers* Layers;
  std::vector<std::uint8_t> Given;
};

/// The depths of the nearest surfaces that are left of all processes'.
std::vector<float> NearestOfAll(const PictureGroup& group, const OwnSurfaces& own)
{
  std::vector<float> depth;
  group.together([&] {
    depth.resize(own.pixels());
    for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
      depth[pixel] = own.depth(pixel);
    }
  });
  group.reduce(depth, PictureGroup::Reduction::Least);
  return depth;
}

/// The pixels that have a surface there, the same in all processes.
std::vector<std::size_t> Covered(const PictureGroup& group, const std::vector<float>& depth)
{
  std::vector<std::size_t> pixels;
  group.together([&] {
    for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
      if (depth[pixel] < 1.0f) {
        pixels.push_back(pixel);
      }
    }
  });
  return pixels;
}

/// Whose surface each of the pixels shows: of one depth, the first process'.
std::vector<float> OwnersOf(const PictureGroup& group, const OwnSurfaces& own,
                            const std::vector<float>& depth, const std::vector<std::size_t>& pixels)
{
  const auto nobody = static_cast<float>(group.processes());
  const auto here = static_cast<float>(group.process());
  std::vector<float> owners;
  group.together([&] {
    for (const std::size_t pixel : pixels) {
      owners.push_back(own.depth(pixel) == depth[pixel] ? here : nobody);
    }
  });
  group.reduce(owners, PictureGroup::Reduction::Least);
  return owners;
}

/// The layer of the surfaces at `depth`, which their owners give away.
TranslucentLayers::Layer TakeLayer(const PictureGroup& group, OwnSurfaces& own,
                                   std::vector<float> depth, const std::vector<std::size_t>& pixels)
{
  const std::vector<float> owners = OwnersOf(group, own, depth, pixels);
  const auto here = static_cast<float>(group.process());
  std::vector<float> colors; // four to a pixel, 0 where they are others'
  group.together([&] {
    colors.resize(4 * pixels.size());
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      if (owners[k] == here) {
        std::copy_n(&own.take(pixels[k]).x, 4, &colors[4 * k]);
      }
    }
  });
  group.reduce(colors, PictureGroup::Reduction::Sum);
  TranslucentLayers::Layer layer;
  group.together([&] {
    layer.depth = std::move(depth);
    layer.colors.resize(layer.depth.size());
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      std::copy_n(&colors[4 * k], 4, &layer.colors[pixels[k]].x);
    }
  });
  return layer;
}

} // namespace

std::shared_ptr<const TranslucentLayers>
ShareLayers(const PictureGroup& group, const std::shared_ptr<const TranslucentLayers>& own,
            std::size_t pixels)
{
  if (group.isAlone() || group.all(!own)) {
    return own;
  }
  const auto shared = std::make_shared<TranslucentLayers>();
  std::unique_ptr<OwnSurfaces> surfaces;
  group.together([&] { surfaces = std::make_unique<OwnSurfaces>(own.get(), pixels); });
  while (shared->count() < MostLayers(static_cast<std::int64_t>(pixels))) {
    std::vector<float> depth = NearestOfAll(group, *surfaces);
    const std::vector<std::size_t> pixelsCovered = Covered(group, depth);
    if (pixelsCovered.empty()) {
      break;
    }
    shared->layers.push_back(TakeLayer(group, *surfaces, std::move(depth), pixelsCovered));
  }
  return shared;
}

} // namespace inr
