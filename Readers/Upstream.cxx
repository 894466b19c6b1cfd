// SPDX-License-Identifier: BSD-3-Clause
#include "Upstream.h"

#include "Core/Error.h"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkCallbackCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkImageReader2.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>

#ifdef INR_WITH_PARAVIEW
#include <vtkMetaReader.h>
#endif

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

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

/// Bytes of the values that a reader of one raw file was told of; 0 for any other reader.
std::uint64_t RawBytes(vtkImageReader2* reader)
{
  const std::string name = reader->GetClassName();
  const bool raw = name == "vtkImageReader" || name == "vtkMPIImageReader";
  if (!raw || !reader->GetFileName() || reader->GetFileDimensionality() != 3) {
    return 0;
  }
  std::uint64_t bytes =
      static_cast<std::uint64_t>(reader->GetNumberOfScalarComponents()) *
      static_cast<std::uint64_t>(vtkDataArray::GetDataTypeSize(reader->GetDataScalarType()));
  const int* extent = reader->GetDataExtent();
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t voxels = std::int64_t{extent[2 * axis + 1]} - extent[2 * axis] + 1;
    bytes *= static_cast<std::uint64_t>(std::max<std::int64_t>(voxels, 0));
  }
  return bytes;
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

std::string FindWholeFileReader(vtkAlgorithm* algorithm)
{
  for (vtkAlgorithm* reader : UpstreamOf(algorithm)) {
    if (reader->IsA("vtkMetaImageReader")) {
      return reader->GetClassName();
    }
  }
  return {};
}

bool ComesFromApplication(vtkAlgorithm* algorithm)
{
  const std::vector<vtkAlgorithm*> all = UpstreamOf(algorithm);
  return std::any_of(all.begin(), all.end(),
                     [](vtkAlgorithm* other) { return other->IsA("vtkTrivialProducer") != 0; });
}

std::string FindBadRawFile(vtkAlgorithm* algorithm)
{
  for (vtkAlgorithm* other : UpstreamOf(algorithm)) {
    auto* reader = vtkImageReader2::SafeDownCast(other);
    const std::uint64_t wanted = reader ? RawBytes(reader) : 0;
    if (wanted == 0) {
      continue;
    }
    if (!std::ifstream(reader->GetFileName())) {
      return "'" + std::string(reader->GetFileName()) + "' cannot be opened for reading";
    }
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(reader->GetFileName(), unknown);
    if (!unknown && size < wanted) {
      return "'" + std::string(reader->GetFileName()) + "' has " + std::to_string(size) +
             " bytes, and the reader's DataExtent, DataScalarType and NumberOfScalarComponents "
             "ask for " +
             std::to_string(wanted) + "; correct these, or the file is incomplete";
    }
  }
  return {};
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
    std::string& first = static_cast<UpstreamErrors*>(self)->First;
    first = first.empty() ? message : first;
    vtkOutputWindow::GetInstance()->DisplayErrorText(message); // which VTK leaves to observers
  });
  this->Watched.emplace_back(object, object->AddObserver(vtkCommand::ErrorEvent, keep));
}

UpstreamErrors::~UpstreamErrors()
{
  for (const auto& [object, tag] : this->Watched) {
    if (object) {
      object->RemoveObserver(tag);
    }
  }
}

void UpstreamErrors::check() const
{
  if (this->First.empty()) {
    return;
  }
  std::string text = this->First;
  std::replace(text.begin(), text.end(), '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  throw inr::Error(inr::ErrorCode::CannotRead, "the data could not be read: " + text);
}
