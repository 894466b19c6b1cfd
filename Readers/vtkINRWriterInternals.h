// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Readers/Training/ReadingPlan.h"
#include "Readers/Training/StepSequence.h"
#include "Readers/Training/TrainingBackend.h"
#include "vtkINRWriter.h"

#include <vtkMultiProcessController.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <memory>
#include <string>

constexpr std::int64_t MiB = std::int64_t{1} << 20;

/// What a writer consists of, but for its properties.
class vtkINRWriter::Internals
{
public:
  StepSequence Steps;  ///< those of WriteTimeSteps
  std::string Problem; ///< why there are none
  std::string Target;  ///< the file that is being written
  ReadingPlan Reading; ///< of the input
  bool MayProbe = false;
  bool IsReached = false; ///< by what it asked for, whatever came
  bool IsWriting = false; ///< the steps stay those that there were at the beginning
  vtkSmartPointer<vtkMultiProcessController> Controller =
      vtkMultiProcessController::GetGlobalController();
  bool ShowsHidden = false; ///< of the file in work; see TrainingInput
  /// Of this Write; null = not looked for. Who trains has it, too: Backend may be set meanwhile.
  std::shared_ptr<TrainingBackend> Beside;
  /// What was written last, if it is of a time step; while one is trained, what that began with.
  inr::ModelPointer Previous;
};
