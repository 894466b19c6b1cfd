// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Core/Training/Checkpoint/CheckpointOptions.h"

#include <mutex>
#include <string>
#include <vector>

class vtkObject;

/// The checkpoint beside a model file in the making: FILE.checkpoint.
class TrainingCheckpoint
{
public:
  /// `interval` in seconds, 0 = no checkpoint. `writer` is who warns.
  TrainingCheckpoint(vtkObject* writer, const std::string& target, double interval, bool resume);

  /// For the training; this must outlive it.
  inr::CheckpointOptions options();

  /// Tells the user what the training, maybe on a thread of its own, has told; on the thread that
  /// made this.
  void tell();

  /// Removes what is of this training, and of a group what process `rank` has: when the model is
  /// safe.
  void remove(int rank);

  /// The error, which says that there is a checkpoint, where it is of use.
  inr::Error complete(const inr::Error& error);

private:
  void note(inr::CheckpointEvent event, const std::string& text);

  vtkObject* Writer;
  std::string Path;
  double Interval;
  bool Resume;
  std::mutex Mutex;
  std::vector<std::string> News;
  std::vector<std::string> Warnings;
  bool Ours = false;      ///< the training went on from there, or has written it
  bool HasSurvey = false; ///< of this process
};
