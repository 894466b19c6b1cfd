// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickSource.h"

#include "Core/Model/Model.h"

#include <glm/common.hpp>

#include <algorithm>
#include <utility>

namespace inr {

namespace {

/// The part of a brick that lies inside its level.
struct BrickBox
{
  glm::i64vec3 first;
  glm::i64vec3 count;
};

BrickBox BoxOf(const Hierarchy& hierarchy, const BrickId& id)
{
  const glm::i64vec3 first = hierarchy.firstVoxel(id);
  return {first, glm::min(glm::i64vec3(hierarchy.brickDims()), hierarchy.size(id.level) - first)};
}

class FieldBricks : public BrickSource
{
public:
  FieldBricks(std::shared_ptr<const Evaluator> field, const Hierarchy& hierarchy)
      : BrickSource(hierarchy), Field(std::move(field))
  {}

  void inferLayer(BrickKey key, std::int64_t z, float* values) const override
  {
    const BrickId id = IdOf(key);
    const BrickBox box = BoxOf(this->hierarchy(), id);
    const std::vector<float> inside = this->layerInside(id, box, glm::min(z, box.count.z - 1));
    const glm::i64vec3 dims(this->hierarchy().brickDims());
    for (std::int64_t y = 0; y < dims.y; ++y) {
      const std::int64_t row = glm::min(y, box.count.y - 1) * box.count.x;
      for (std::int64_t x = 0; x < dims.x; ++x) {
        const std::int64_t from = row + glm::min(x, box.count.x - 1);
        values[y * dims.x + x] = inside[static_cast<std::size_t>(from)];
      }
    }
  }

private:
  std::vector<float> layerInside(const BrickId& id, const BrickBox& box, std::int64_t z) const
  {
    const std::int64_t points = id.level == 0 ? 1 : 2; // of each voxel, along an axis
    const glm::i64vec3 begin(box.first.x, box.first.y, box.first.z + z);
    const glm::i64vec3 count(box.count.x, box.count.y, 1);
    std::vector<float> axes[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto size = static_cast<double>(this->hierarchy().size(id.level)[axis]);
      for (std::int64_t k = 0; k < count[axis] * points; ++k) {
        const double within = (static_cast<double>(k) + 0.5) / static_cast<double>(points);
        const double u = (static_cast<double>(begin[axis]) + within) / size;
        axes[axis].push_back(static_cast<float>(u));
      }
    }
    std::vector<float> sampled(axes[0].size() * axes[1].size() * axes[2].size());
    this->Field->evaluateGrid(axes, sampled.data());
    return points == 1 ? Clamped(sampled) : Filtered(sampled, box.count.x, box.count.y);
  }

  static std::vector<float> Clamped(std::vector<float> values)
  {
    for (float& value : values) {
      value = NormalisedOutput(value);
    }
    return values;
  }

  /// Means over 2 x 2 x 2 points; two layers of 2 width x 2 height come in.
  static std::vector<float> Filtered(const std::vector<float>& points, std::int64_t width,
                                     std::int64_t height)
  {
    std::vector<float> means(static_cast<std::size_t>(width * height));
    const auto at = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      const std::int64_t index = x + 2 * width * (y + 2 * height * z);
      return NormalisedOutput(points[static_cast<std::size_t>(index)]);
    };
    for (std::int64_t y = 0; y < height; ++y) {
      for (std::int64_t x = 0; x < width; ++x) {
        float sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
          sum += at(2 * x + (corner & 1), 2 * y + (corner >> 1 & 1), corner >> 2);
        }
        means[static_cast<std::size_t>(y * width + x)] = sum / 8;
      }
    }
    return means;
  }

  std::shared_ptr<const Evaluator> Field;
};

} // namespace

std::int64_t BrickSource::points(BrickKey key) const
{
  const BrickId id = IdOf(key);
  const glm::i64vec3 count = BoxOf(this->Levels, id).count;
  return count.x * count.y * count.z * (id.level == 0 ? 1 : 8);
}

void BrickSource::infer(const BrickKey* keys, std::int64_t count, float* values,
                        const Arena& arena) const
{
  const std::int64_t layers = this->Levels.brickDims().z;
  const std::int64_t layer = this->Levels.voxelsPerBrick() / layers;
  arena.forEachBlock(count * layers, 1, [&](std::int64_t k, std::int64_t) {
    const BrickKey key = keys[k / layers];
    if (k % layers < this->layersInside(key)) {
      this->inferLayer(key, k % layers, values + k * layer);
    }
  });
  for (std::int64_t k = 0; k < count; ++k) {
    this->repeatLastLayer(keys[k], values + k * layers * layer);
  }
}

std::int64_t BrickSource::layersInside(BrickKey key) const
{
  return BoxOf(this->Levels, IdOf(key)).count.z;
}

void BrickSource::repeatLastLayer(BrickKey key, float* values) const
{
  const std::int64_t layers = this->Levels.brickDims().z;
  const std::int64_t layer = this->Levels.voxelsPerBrick() / layers;
  const std::int64_t inside = this->layersInside(key);
  for (std::int64_t z = inside; z < layers; ++z) {
    std::copy_n(values + (inside - 1) * layer, layer, values + z * layer);
  }
}

std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const Evaluator> field,
                                                   const Hierarchy& hierarchy)
{
  return std::make_shared<FieldBricks>(std::move(field), hierarchy);
}

} // namespace inr
