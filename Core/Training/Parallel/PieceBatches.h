// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Parallel/VolumePart.h"
#include "Core/Training/Samples/BatchSource.h"

#include <cstdint>
#include <vector>

namespace inr {

/// The share of large mini-batches that falls into one part of a volume. With n processes a
/// mini-batch is n of those that one process would draw, one after the other, and each takes the
/// samples that lie in its part: together they are the samples of one process with an n-fold batch.
class PieceBatches : public BatchSource
{
public:
  /// `part` must outlive this.
  PieceBatches(const VolumePart& part, double low, double high, int processes);

  void prepare(const TrainingStep& step, const StopCheck& check) override;
  std::int64_t count() const override { return static_cast<std::int64_t>(this->Mine.size()); }
  std::int64_t total() const override { return this->Processes * BatchSize; }
  void draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin, std::int64_t end,
            glm::vec3* positions, float* targets) const override;

private:
  const VolumePart& Part;
  double Low;
  double High;
  std::int64_t Processes;
  StratifiedPositions Boxes;
  std::vector<std::int64_t> Near; ///< boxes that may hold positions of this part
  std::vector<glm::vec3> Mine;    ///< of the prepared mini-batch
};

} // namespace inr
