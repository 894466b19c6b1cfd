// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/StratifiedPositions.h"

#include "Core/Training/Samples/Trilinear.h"

namespace inr {

StratifiedPositions::StratifiedPositions(const glm::i64vec3& dims, std::int64_t count)
    : Dims(dims), Boxes(HalveLongest(dims, glm::dvec3(dims), count))
{}

glm::vec3 StratifiedPositions::at(std::int64_t k, std::uint64_t stream, std::uint64_t drawn) const
{
  const glm::vec3 position = PositionInBox(this->Boxes.corners[static_cast<std::size_t>(k)],
                                           this->Boxes.extent, this->Dims, stream, drawn);
  return IsOfVoxel(drawn, this->Boxes.corners.size()) ? VoxelCentre(position, this->Dims)
                                                      : position;
}

} // namespace inr
