// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Quality/CellRanges.h"
#include "Core/Training/Quality/PsnrEstimate.h"
#include "Core/Training/Quality/Quality.h"
#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/Samples/SamplePool.h"
#include "Core/Training/Streaming/StreamBudget.h"
#include "Core/Training/Volume/VolumeReader.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace inr {

/// A volume that is read in pieces, on the thread that made this: first as a whole, then block by
/// block while a training goes on, then for the quality. Each process of a group reads its share of
/// the blocks; they call together what is said to be for all, and then read as often as each other,
/// at the same time, since there are readers that only work together.
class StreamedVolume
{
public:
  /// Receives the share that is done; throws to stop.
  using Progress = std::function<void(double)>;

  StreamedVolume(VolumeReader& reader, const StreamBudget& budget, int macroCellSize,
                 const TrainingOptions& options, const TrainingGroup& group, const Arena& arena);

  /// The first reading; for all.
  void survey(const Progress& progress);

  /// Where all that lies in memory that it has told, with what was read again since. After other
  /// bytes were put there: resume(), which says whether they can be those of a volume like this.
  StateArrays state();
  bool resume();

  /// Reads a few blocks and says whether the volume is still the one that state() tells of; others
  /// for another `number`. For all.
  bool isAsBefore(std::uint64_t number);

  const VolumeStatistics& statistics() const { return this->Statistics; }
  double surveySeconds() const { return this->SurveySeconds; } ///< of the slowest process

  /// Of the random voxels of PsnrEstimate the first `voxels`, at most StoringVoxels.
  PsnrEstimate estimate(std::int64_t voxels) const;

  SamplePool& pool() { return this->Pool; }

  /// Lets the pool be trained from; the share `rereads` of it is to be read again.
  SamplePool& begin(double rereads);

  /// The largest share that leaves not more than three times the volume to be read in all, as far
  /// as the survey has left that and but for what is read around the bars of the quality.
  double mostRereads() const;

  /// Reads the block again that the pool wants, or waits a moment when there is none. Throws
  /// Error(InvalidArgument) where a value is outside the range that the survey found, more values
  /// are not finite than it found in all, or one of the estimate's is not what it was.
  void readAgain();

  /// Reads the blocks again that are to be read before a step, where one thread reads and trains;
  /// false where `check` of one process says to stop before all are read. Throws as readAgain, and
  /// as `check` does. For all.
  bool readBefore(const TrainingStep& step, const StopCheck& check);

  /// Compares all voxels, or some where they are many, with a model of them. Throws as readAgain
  /// and, of all voxels, where another number of them is finite. For all.
  DecodedReport measure(const Evaluator& evaluator, const Model& model, const Progress& progress);

private:
  bool measuresAll() const;
  BlockGrid measuredBoxes() const;
  VolumePiece read(const GridBox& box);
  void requireKnownRange(const VolumePiece& piece, const GridBox& box) const;
  void readNothing();
  VolumePiece readFirst(std::int64_t block);
  bool needsOrigin() const;
  void fixOrigin(const VolumePiece& piece);
  void survey(std::int64_t block, const VolumePiece& piece);
  bool isAsBefore(std::uint64_t stream, std::int64_t k);
  void sampleEstimate(std::int64_t block, const VolumePiece& piece);
  void requireKnownFinite(std::int64_t finite) const;
  std::vector<std::size_t> estimatesWithin(const GridBox& box) const;
  void requireKnownValues(const VolumePiece& piece, const GridBox& box,
                          const std::vector<std::size_t>& estimates) const;
  double tolerance() const;
  bool allGoOn(const StopCheck& check) const;
  void shareEstimates();
  void readAgain(std::int64_t block);
  void measureShare(const BlockGrid& boxes, const std::vector<std::int64_t>& chosen,
                    QualityMeter& meter, CellRanges* decoded, const Progress& progress);

  VolumeReader& Reader;
  const TrainingGroup& Group;
  const Arena& Threads;
  int MacroCellSize;
  std::uint64_t Seed;
  std::int64_t MeasuredVoxels; ///< of more than four times as many
  std::int64_t BlockVoxels;    ///< that may be read at a time
  BlockGrid Blocks;
  BlockShare Share;
  SamplePool Pool;
  bool HasOrigin = false; ///< the pool, from the survey
  VolumeStatistics Statistics;
  CellRanges Ranges; ///< of the data
  double SurveySeconds = 0;
  std::vector<glm::vec3> EstimatePositions;
  std::vector<double> EstimateValues;                      ///< above the pool's origin
  std::vector<std::vector<std::size_t>> EstimatesOfBlocks; ///< numbers of positions
};

} // namespace inr
