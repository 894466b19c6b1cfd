// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Checkpoint/CheckpointOptions.h"
#include "Core/Training/Runtime/TrainingClock.h"

#include <optional>
#include <string>
#include <utility>

namespace inr {

/// Keeps one training on disk while it runs, as its options say, and takes it up again. Without a
/// path it does nothing.
class CheckpointKeeper
{
public:
  /// Removes what processes that were killed while they wrote this checkpoint have left.
  CheckpointKeeper(CheckpointOptions options, TrainingIdentity identity);

  /// What to write in front of the training's own arrays, each time; see WriteCheckpoint.
  void keep(StateArrays survey) { this->Survey = std::move(survey); }

  /// Fills the arrays from the checkpoint and says how far the training was; nothing where it
  /// begins anew, for want of a checkpoint or of a fitting one.
  std::optional<TrainingState> resume(const StateArrays& arrays);

  /// Counts `seconds` before the first step towards the interval: what the survey took is lost,
  /// too.
  void count(double seconds) { this->SinceWritten = TrainingClock(seconds); }

  /// Whether it is time to write again.
  bool isDue() const;

  /// Replaces the checkpoint. Where that fails, the one of before stays, and the user is told once.
  void write(const TrainingState& state, const StateArrays& arrays);

  /// The same when all steps are done, for what comes after them may take long, too; not of a
  /// training so short that it needed none.
  void writeAtEnd(const TrainingState& state, const StateArrays& arrays);

  /// Whether nothing is left to writeAtStop: the checkpoint has all steps, or there is to be none.
  bool isDone() const { return this->HasAll || this->Options.path.empty(); }

  /// For a training that stops before its end: writes and says, for the user, what is kept.
  std::string writeAtStop(const TrainingState& state, const StateArrays& arrays);

private:
  bool isKept() const;
  std::string replace(const TrainingState& state, const StateArrays& arrays);
  void tell(CheckpointEvent event, const std::string& text) const;

  CheckpointOptions Options;
  TrainingIdentity Identity;
  StateArrays Survey;
  TrainingClock SinceWritten;
  double WriteSeconds = 0; ///< that the last took
  bool HasWritten = false; ///< or gone on from
  bool HasAll = false;     ///< steps, in the last that was written, or gone on from
  bool HasFailed = false;
  bool IsOthers = false; ///< what is at the path: it is set aside before it is replaced
};

} // namespace inr
