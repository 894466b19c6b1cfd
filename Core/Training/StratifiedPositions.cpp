// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/StratifiedPositions.h"

namespace inr {

StratifiedPositions::StratifiedPositions(const glm::i64vec3& dims, std::int64_t count)
    : Dims(dims), Boxes(HalveLongest(dims, glm::dvec3(dims), count))
{}

glm::vec3 StratifiedPositions::at(std::int64_t k, std::uint64_t stream, std::uint64_t drawn) const
{
  const glm::vec3 position = PositionInBox(this->Boxes.corners[static_cast<std::size_t>(k)],
                                           this->Boxes.extent, this->Dims, stream, drawn);
  // By turns: a box gets both kinds from batch to batch.
  const bool free = (drawn + drawn / this->Boxes.corners.size()) % 2 == 0;
  return free ? position : VoxelCentre(position, this->Dims);
}

} // namespace inr
