// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Parallel/PieceBatches.h"

#include <algorithm>

namespace inr {

PieceBatches::PieceBatches(const VolumePart& part, double low, double high, int processes)
    : Part(part), Low(low), High(high), Processes(processes), Boxes(part.dims(), BatchSize)
{
  const HalvedCube& cube = this->Boxes.boxes();
  for (std::int64_t k = 0; k < cube.count(); ++k) {
    if (part.isNear(cube.corners[static_cast<std::size_t>(k)], cube.extent)) {
      this->Near.push_back(k);
    }
  }
}

void PieceBatches::prepare(const TrainingStep& step, const StopCheck&)
{
  this->Mine.clear();
  for (std::int64_t batch = 0; batch < this->Processes; ++batch) {
    const std::uint64_t first = (step.number * static_cast<std::uint64_t>(this->Processes) +
                                 static_cast<std::uint64_t>(batch)) *
                                BatchSize;
    for (const std::int64_t k : this->Near) {
      const glm::vec3 position =
          this->Boxes.at(k, step.stream, first + static_cast<std::uint64_t>(k));
      if (this->Part.holds(position)) {
        this->Mine.push_back(position);
      }
    }
  }
}

void PieceBatches::draw(std::uint64_t, std::uint64_t, std::int64_t begin, std::int64_t end,
                        glm::vec3* positions, float* targets) const
{
  std::copy(this->Mine.begin() + begin, this->Mine.begin() + end, positions);
  this->Part.sample(positions, end - begin, this->Low, this->High, targets);
}

} // namespace inr
