// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/ChannelTruth.h"

#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Random.h"
#include "Testing/Turbulence/ChannelGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace inr {
namespace {

constexpr std::int64_t BlockSize = 16384;

struct Sums
{
  double squared = 0;
  double largest = 0;
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value, double error)
  {
    this->squared += error * error;
    this->largest = std::max(this->largest, std::abs(error));
    this->low = std::min(this->low, value);
    this->high = std::max(this->high, value);
  }
  void add(const Sums& other)
  {
    this->squared += other.squared;
    this->largest = std::max(this->largest, other.largest);
    this->low = std::min(this->low, other.low);
    this->high = std::max(this->high, other.high);
  }
};

class Comparison
{
public:
  Comparison(ModelPointer model, const TurbulentChannel& field, std::int64_t voxels,
             std::uint64_t seed)
      : Volume(model->volume), Network(MakeEvaluator(model)), Grid(field, model->volume.dims),
        Voxels(voxels), Seed(seed)
  {}

  Sums block(std::int64_t begin, std::int64_t end) const
  {
    std::vector<glm::vec3> positions;
    std::vector<double> truth;
    ChannelGrid::Plane scratch;
    for (std::int64_t number = begin; number < end; ++number) {
      const glm::i64vec3 voxel = this->draw(number);
      truth.push_back(this->value(this->Grid.plane(voxel.z, scratch), voxel));
      positions.emplace_back((glm::dvec3(voxel) + 0.5) / glm::dvec3(this->Volume.dims));
    }
    return this->compare(positions, truth);
  }

private:
  // Voxel `number` of the drawing: from its own part of z, so that neighbours share a plane.
  glm::i64vec3 draw(std::int64_t number) const
  {
    const glm::dvec3 size(this->Volume.dims);
    glm::dvec3 u;
    for (int axis = 0; axis < 3; ++axis) {
      const auto counter = static_cast<std::uint64_t>(3 * number + axis);
      u[axis] = static_cast<double>(RandomBits(this->Seed, counter) >> 11) * 0x1p-53;
    }
    u.z = (static_cast<double>(number) + u.z) / static_cast<double>(this->Voxels);
    return glm::i64vec3(glm::min(glm::floor(u * size), size - 1.0));
  }

  double value(const ChannelGrid::Plane& plane, const glm::i64vec3& voxel) const
  {
    double value = 0;
    this->Grid.row(plane, voxel.y, voxel.x, 1, &value);
    return this->Volume.type == ScalarType::Float32 ? static_cast<float>(value) : value;
  }

  Sums compare(const std::vector<glm::vec3>& positions, const std::vector<double>& truth) const
  {
    std::vector<float> outputs(positions.size());
    this->Network->evaluate(positions.data(), static_cast<std::int64_t>(positions.size()),
                            outputs.data());
    Sums sums;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      sums.add(truth[k], ValueOf(this->Volume, NormalisedOutput(outputs[k])) - truth[k]);
    }
    return sums;
  }

  VolumeInfo Volume;
  std::shared_ptr<const Evaluator> Network;
  ChannelGrid Grid;
  std::int64_t Voxels;
  std::uint64_t Seed;
};

} // namespace

ChannelError MeasureChannelError(ModelPointer model, const TurbulentChannel& field,
                                 std::int64_t voxels, std::uint64_t seed, const Arena& arena)
{
  if (voxels < 1) {
    throw Error(ErrorCode::InvalidArgument, "at least one voxel has to be compared");
  }
  const double peak = model->volume.high - model->volume.low;
  const Comparison comparison(std::move(model), field, voxels, seed);
  std::vector<Sums> blocks(static_cast<std::size_t>((voxels + BlockSize - 1) / BlockSize));
  arena.forEachBlock(voxels, BlockSize, [&](std::int64_t begin, std::int64_t end) {
    blocks[static_cast<std::size_t>(begin / BlockSize)] = comparison.block(begin, end);
  });
  Sums all;
  for (const Sums& sums : blocks) {
    all.add(sums);
  }
  const double rms = std::sqrt(all.squared / static_cast<double>(voxels));
  return {voxels, 20 * std::log10(peak / rms), all.largest, rms, all.low, all.high};
}

} // namespace inr
