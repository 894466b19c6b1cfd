// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/CellRanges.h"
#include "Core/Training/PsnrEstimate.h"
#include "Core/Training/Quality.h"
#include "Core/Training/SamplePool.h"
#include "Core/Training/StreamBudget.h"
#include "Core/Training/VolumeReader.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace inr {

/// A volume that is read in pieces, on the thread that made this: first as a whole, then block by
/// block while a training goes on, then for the quality.
class StreamedVolume
{
public:
  /// Receives the share that is done; throws to stop.
  using Progress = std::function<void(double)>;

  StreamedVolume(VolumeReader& reader, const StreamBudget& budget, int macroCellSize,
                 const TrainingOptions& options, const Arena& arena);

  /// The first reading.
  void survey(const Progress& progress);
  const VolumeStatistics& statistics() const { return this->Statistics; }
  double surveySeconds() const { return this->SurveySeconds; }

  /// Of the random voxels of PsnrEstimate the first `voxels`, at most StoringVoxels.
  PsnrEstimate estimate(std::int64_t voxels) const;

  /// Lets the pool be trained from; the share `rereads` of it is to be read again.
  SamplePool& begin(double rereads);

  /// The largest share that leaves not more than three times the volume to be read in all.
  double mostRereads() const;

  /// Reads the block again that the pool wants, or waits a moment when there is none. Throws
  /// Error(InvalidArgument) where a value is outside the range that the survey found.
  void readAgain();

  /// Compares all voxels, or some where they are many, with a model of them. Throws as readAgain.
  DecodedReport measure(const Evaluator& evaluator, const Model& model, const Progress& progress);

private:
  bool measuresAll() const;
  VolumePiece read(const VoxelBox& box);
  void requireKnownRange(const VolumePiece& piece, const VoxelBox& box) const;
  void sampleEstimate(std::int64_t block, const VolumePiece& piece);

  VolumeReader& Reader;
  const Arena& Threads;
  int MacroCellSize;
  std::uint64_t Seed;
  std::int64_t MeasuredVoxels; ///< of more than four times as many
  std::int64_t BlockVoxels;    ///< that may be read at a time
  BlockGrid Blocks;
  SamplePool Pool;
  VolumeStatistics Statistics;
  CellRanges Ranges; ///< of the data
  double SurveySeconds = 0;
  std::vector<glm::vec3> EstimatePositions;
  std::vector<double> EstimateValues;
  std::vector<std::vector<std::size_t>> EstimatesOfBlocks; ///< numbers of positions
};

} // namespace inr
