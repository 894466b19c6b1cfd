// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/TrainingBackend.h"

#include "Core/Training/Samples/BatchSource.h"

#include <vtkObject.h>
#include <vtkSetGet.h>

#include <utility>

TrainingBackend::TrainingBackend(vtkObject* writer,
                                 std::shared_ptr<const inr::TrainingAccelerator> accelerator,
                                 const std::string& reason, bool asked)
    : Writer(writer), Asked(asked), Accelerator(std::move(accelerator))
{
  if (asked && !this->Accelerator) {
    this->Warnings.push_back("There is no GPU for Backend CUDA (" + reason +
                             "). The CPU trains instead; with Backend Auto or CPU it does so "
                             "without a word.");
  }
}

inr::AccelerationOptions TrainingBackend::options()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  inr::AccelerationOptions options;
  options.accelerator = this->Accelerator;
  options.tell = [this](inr::AccelerationEvent event, const std::string& text) {
    this->note(event, text);
  };
  return options;
}

void TrainingBackend::note(inr::AccelerationEvent event, const std::string& text)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  if (event == inr::AccelerationEvent::Failed) {
    this->Accelerator = nullptr;
    this->Warnings.push_back("The GPU has failed and is not used any more: " + text + ".");
  } else if (this->Asked) {
    this->Warnings.push_back("The GPU cannot be used for this training: " + text +
                             ". The CPU trains instead.");
  }
}

void TrainingBackend::tell(bool loud)
{
  std::vector<std::string> warnings;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    warnings.swap(this->Warnings);
  }
  for (const std::string& text : warnings) {
    if (loud && text != this->Told) { // the same of each time step is not
      this->Told = text;
      vtkWarningWithObjectMacro(this->Writer, << text);
    }
  }
}

std::string BackendText(const inr::TrainingRecord& training)
{
  return training.backend + "; " +
         (training.pipeline == inr::TrainingPipeline::Storage ? "data in " : "volume in ") +
         inr::TrainingPipelineName(training.pipeline);
}
