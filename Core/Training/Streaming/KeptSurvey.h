// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/Streaming/StreamedVolume.h"
#include "Core/Training/Trainer.h"
#include "Core/Training/TrainingRun.h"

#include <cstdint>
#include <optional>
#include <string>

namespace inr {

/// What the first reading of a volume has told, kept on disk for a training that goes on. That of a
/// process on its own is in the checkpoint, as of its last step. Each process of a group has a file
/// of its own beside the checkpoint, as of before the first step: what is read again from there on
/// depends on the step alone, so that it fits every checkpoint of the training.
class KeptSurvey
{
public:
  /// All of these must outlive it.
  KeptSurvey(const VolumeInfo& whole, const TrainingOptions& options, const TrainingGroup& group);

  /// Takes up what is kept, as long as it is of the training that is asked for, whatever trained
  /// then and trains now, and the volume still looks the same, in all processes, and there is a
  /// checkpoint. False otherwise; then `volume` may have become anything. What may be wrong with a
  /// checkpoint the user learns where the training goes on from it, or not. For all.
  bool resume(StreamedVolume& volume) const;

  /// Of a group: writes the files, unless reading takes less time than training from one checkpoint
  /// to the next, which may have to be done again, too. `resumed`: they are there.
  void keep(StreamedVolume& volume, const TrainingRun& run, bool resumed) const;

private:
  /// What the checkpoint says.
  struct Before
  {
    std::string training; ///< its identity
    std::uint64_t steps = 0;
  };

  bool isThere() const;
  std::optional<TrainingIdentity> load(StreamedVolume& volume) const;
  bool isOfTheTraining(const TrainingIdentity& mine, const Before& before) const;
  Before before() const;

  const VolumeInfo& Whole;
  const TrainingOptions& Options;
  const TrainingGroup& Group;
  std::string Path;
};

/// The file beside a checkpoint that process `rank` of a group has.
std::string SurveyPath(const std::string& checkpoint, int rank);

/// Removes those of all processes, however many there were; fails silently.
void RemoveSurveys(const std::string& checkpoint);

} // namespace inr
