// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/Upstream.h"

#include "Core/Error.h"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkCallbackCommand.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#ifdef INR_WITH_PARAVIEW
#include <vtkFileSeriesReader.h>
#include <vtkMetaReader.h>
#endif

#include <algorithm>

namespace {

/// What reads the files of a series: ParaView hides it in another reader.
vtkAlgorithm* InnerReader(vtkAlgorithm* algorithm)
{
#ifdef INR_WITH_PARAVIEW
  auto* outer = vtkMetaReader::SafeDownCast(algorithm);
  return outer ? outer->GetReader() : nullptr;
#else
  (void)algorithm;
  return nullptr;
#endif
}

/// Whether data are known to be of the time that is asked for, where there are several.
bool IsOfItsTime(vtkInformation& asked, vtkInformation& there)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (!asked.Has(Pipeline::TIME_RANGE()) || !asked.Has(Pipeline::UPDATE_TIME_STEP())) {
    return true;
  }
  return there.Has(vtkDataObject::DATA_TIME_STEP()) &&
         there.Get(vtkDataObject::DATA_TIME_STEP()) == asked.Get(Pipeline::UPDATE_TIME_STEP());
}

/// As VTK does, which leaves it to whoever observes.
void Show(const char* message) { vtkOutputWindow::GetInstance()->DisplayErrorText(message); }

void AddUpstream(vtkAlgorithm* algorithm, std::vector<vtkAlgorithm*>& found)
{
  if (!algorithm || std::find(found.begin(), found.end(), algorithm) != found.end()) {
    return;
  }
  found.push_back(algorithm);
  AddUpstream(InnerReader(algorithm), found);
  for (vtkAlgorithm* other : UpstreamOf(algorithm)) {
    AddUpstream(other, found);
  }
}

} // namespace

std::vector<vtkAlgorithm*> UpstreamOf(vtkAlgorithm* algorithm)
{
  std::vector<vtkAlgorithm*> found;
  for (int port = 0; port < algorithm->GetNumberOfInputPorts(); ++port) {
    for (int k = 0; k < algorithm->GetNumberOfInputConnections(port); ++k) {
      AddUpstream(algorithm->GetInputConnection(port, k)->GetProducer(), found);
    }
  }
  return found;
}

std::vector<std::string> SeriesOf(vtkAlgorithm* reader, vtkAlgorithm* consumer)
{
  std::vector<std::string> files;
#ifdef INR_WITH_PARAVIEW
  for (vtkAlgorithm* outer : UpstreamOf(consumer)) {
    auto* series = vtkFileSeriesReader::SafeDownCast(outer);
    for (unsigned int k = 0;
         series && series->GetReader() == reader && k < series->GetNumberOfFileNames(); ++k) {
      files.emplace_back(series->GetFileName(k));
    }
  }
#else
  (void)reader;
  (void)consumer;
#endif
  return files;
}

bool ComesFromApplication(vtkAlgorithm* algorithm)
{
  const std::vector<vtkAlgorithm*> all = UpstreamOf(algorithm);
  return std::any_of(all.begin(), all.end(),
                     [](vtkAlgorithm* other) { return other->IsA("vtkTrivialProducer") != 0; });
}

bool IsUpToDate(vtkAlgorithm* algorithm)
{
  auto* producer = vtkDemandDrivenPipeline::SafeDownCast(algorithm->GetInputExecutive());
  vtkDataObject* data = algorithm->GetInputDataObject(0, 0);
  if (!producer || !data || data->GetUpdateTime() <= producer->GetPipelineMTime()) {
    return false;
  }
  return IsOfItsTime(*algorithm->GetInputInformation(), *data->GetInformation());
}

UpstreamErrors::UpstreamErrors(vtkAlgorithm* algorithm)
{
  for (vtkAlgorithm* other : UpstreamOf(algorithm)) {
    this->watch(other);
    this->watch(other->GetExecutive());
  }
}

void UpstreamErrors::watch(vtkObject* object)
{
  vtkNew<vtkCallbackCommand> keep;
  keep->SetClientData(this);
  keep->SetCallback([](vtkObject*, unsigned long, void* self, void* text) {
    const char* message = text ? static_cast<const char*>(text) : "an error without words";
    auto* errors = static_cast<UpstreamErrors*>(self);
    errors->First = errors->First.empty() ? message : errors->First;
    if (errors->Holds) {
      errors->Held.emplace_back(message);
    } else {
      Show(message);
    }
  });
  this->Watched.emplace_back(object, object->AddObserver(vtkCommand::ErrorEvent, keep));
}

UpstreamErrors::~UpstreamErrors() { this->endWatch(); }

void UpstreamErrors::endWatch()
{
  for (const auto& [object, tag] : this->Watched) {
    if (object) {
      object->RemoveObserver(tag);
    }
  }
  this->Watched.clear();
}

void UpstreamErrors::check() const
{
  if (this->First.empty()) {
    return;
  }
  this->show();
  std::string text = this->First;
  std::replace(text.begin(), text.end(), '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  throw inr::Error(inr::ErrorCode::CannotRead, "the data could not be read: " + text);
}

void UpstreamErrors::show() const
{
  for (const std::string& message : this->Held) {
    Show(message.c_str());
  }
}
