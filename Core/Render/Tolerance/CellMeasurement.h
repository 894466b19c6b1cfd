// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Tiles/WorkLimit.h"
#include "Core/Render/Tolerance/LevelErrors.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace inr {

class Arena;

/// Measures LevelErrors of what is seen, within bounds of time and memory.
class CellMeasurement
{
public:
  /// Only where so much has to be measured, or less, as LevelErrors::blockCost counts: some minutes
  /// of work on two cores (7 s of processor time for 27 million voxels).
  static constexpr std::int64_t MostVoxels = std::int64_t{1} << 31;
  /// And so much at once: some seconds, in which a frame cannot be stopped for its time limit, and
  /// 64 MiB of values on each thread.
  static constexpr std::int64_t LargestBlock = std::int64_t{1} << 24;
  /// And only so many cells: 160 MiB. More are known as long as there are no more in all.
  static constexpr std::int64_t MostCells = std::int64_t{1} << 21;

  CellMeasurement(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
                  const glm::i64vec3& cells, const glm::dvec3& spacing, const LineKernel& kernel);

  const LevelErrors& errors() const { return this->Errors; }
  /// Points that the field has been asked for so far.
  std::int64_t points() const { return this->Points; }

  bool areTooMany(std::int64_t blocks) const;
  /// Makes room, should there be none for these blocks, in order, beside what is known.
  void forgetOthersThan(const std::vector<std::int64_t>& seen);
  /// At least a block on each thread, as far as a time limit allows. Whether all were. Throws
  /// Error(Cancelled) when `keepGoing` says so.
  bool measure(const std::vector<std::int64_t>& blocks, const LevelErrors::Question& question,
               const Arena& arena, const WorkLimit& limit, const std::function<bool()>& keepGoing);

private:
  std::shared_ptr<const Evaluator> Field;
  const LineKernel& Kernel;
  LevelErrors Errors;
  std::int64_t Points = 0;
  double SecondsPerRound = 0.1; ///< of measuring a block on each thread: a guess at first
};

} // namespace inr
