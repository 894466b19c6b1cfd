// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Training/Descent/TrainingAccelerator.h"

#include <memory>
#include <mutex>
#include <string>
#include <vector>

class vtkObject;

/// What trains beside the CPU, until it has failed, and what the user is told of it, once.
class TrainingBackend
{
public:
  /// `accelerator` may be null, for `reason`. `asked`: the user wants to know why none trains.
  /// `writer` is who warns.
  TrainingBackend(vtkObject* writer, std::shared_ptr<const inr::TrainingAccelerator> accelerator,
                  const std::string& reason, bool asked);

  /// For a training; this must outlive it.
  inr::AccelerationOptions options();

  /// Tells the user what the training, maybe on a thread of its own, has told; on the thread that
  /// made this. `loud`: else nothing is said, since another process does.
  void tell(bool loud);

private:
  void note(inr::AccelerationEvent event, const std::string& text);

  vtkObject* Writer;
  bool Asked;
  std::mutex Mutex; ///< guards what follows
  std::shared_ptr<const inr::TrainingAccelerator> Accelerator;
  std::vector<std::string> Warnings;
  std::string Told;
};

/// As "CUDA float32, NVIDIA H200; volume in device memory".
std::string BackendText(const inr::TrainingRecord& training);
