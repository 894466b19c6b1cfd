// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace inr {

/// What became of a training's checkpoint.
enum class CheckpointEvent {
  Resumed, ///< the training goes on from it
  Ignored, ///< there is one, but none that this training can go on from
  Written,
  SurveyKept, ///< of a group: what this process has read of the data is in a file beside
  Failed      ///< cannot be written; told once, and the training goes on
};

/// A file from which a training that was stopped or killed goes on, to the very result that it
/// would have had.
struct CheckpointOptions
{
  std::string path; ///< empty = none
  /// Seconds of training between two; longer where writing takes more than a twentieth of the time.
  double interval = 60;
  /// Go on from what is at `path` if it is of the same training: same data, model, settings, seed
  /// and kernel family.
  bool resume = true;
  /// Called on the thread that trains, with a sentence for the user.
  std::function<void(CheckpointEvent, const std::string&)> tell;
};

} // namespace inr
