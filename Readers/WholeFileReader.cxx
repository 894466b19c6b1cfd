// SPDX-License-Identifier: BSD-3-Clause
#include "WholeFileReader.h"

#include "Upstream.h"

#include <vtkAlgorithm.h>
#include <vtkImageReader2.h>

#include <algorithm>
#include <cctype>
#include <fstream>

namespace {

/// Whether a NRRD file's values stand in a file as they are in memory, by its header:
/// https://teem.sourceforge.net/nrrd/format.html#encoding
bool IsRawNrrd(const char* path)
{
  std::ifstream file(path ? path : "", std::ios::binary);
  char buffer[4096]; // what has no lines has no header
  while (file.getline(buffer, sizeof buffer)) {
    std::string line(buffer);
    line.erase(
        std::remove_if(line.begin(), line.end(), [](unsigned char c) { return std::isspace(c); }),
        line.end());
    if (line.empty()) {
      return false; // values follow
    }
    std::transform(line.begin(), line.end(), line.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (line.compare(0, 9, "encoding:") == 0) {
      return line == "encoding:raw";
    }
  }
  return false;
}

bool GivesWholeFiles(vtkAlgorithm* algorithm)
{
  auto* reader = vtkImageReader2::SafeDownCast(algorithm);
  if (reader && reader->IsA("vtkNrrdReader")) {
    return !IsRawNrrd(reader->GetFileName());
  }
  return reader && (reader->IsA("vtkMetaImageReader") || reader->IsA("vtkDICOMImageReader") ||
                    reader->IsA("vtkTGAReader"));
}

} // namespace

std::string FindWholeFileReader(vtkAlgorithm* algorithm)
{
  for (vtkAlgorithm* reader : UpstreamOf(algorithm)) {
    if (GivesWholeFiles(reader)) {
      return reader->GetClassName();
    }
  }
  return {};
}
