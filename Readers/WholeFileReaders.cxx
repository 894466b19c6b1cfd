// SPDX-License-Identifier: BSD-3-Clause
#include "WholeFileReaders.h"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>

#ifdef INR_WITH_PARAVIEW
#include <vtkMetaReader.h>
#endif

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

bool ReadsWholeFiles(vtkAlgorithm* reader) { return reader && reader->IsA("vtkMetaImageReader"); }

} // namespace

std::string FindWholeFileReader(vtkAlgorithm* algorithm)
{
  for (vtkAlgorithm* reader : {algorithm, InnerReader(algorithm)}) {
    if (ReadsWholeFiles(reader)) {
      return reader->GetClassName();
    }
  }
  for (int port = 0; port < algorithm->GetNumberOfInputPorts(); ++port) {
    for (int k = 0; k < algorithm->GetNumberOfInputConnections(port); ++k) {
      std::string found =
          FindWholeFileReader(algorithm->GetInputConnection(port, k)->GetProducer());
      if (!found.empty()) {
        return found;
      }
    }
  }
  return {};
}
