// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/UndividedSource.h"

#include "Readers/Training/Upstream.h"

#include <vtkAlgorithm.h>
#include <vtkImageReader2.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <vector>

namespace {

/// Whether a NRRD file's values stand in a file as they are in memory, by its header
/// (field `encoding` of the format).
bool IsRawNrrd(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
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

/// `consumer`: that it reads for.
bool GivesWholeFiles(vtkAlgorithm* algorithm, vtkAlgorithm* consumer)
{
  auto* reader = vtkImageReader2::SafeDownCast(algorithm);
  if (reader && reader->IsA("vtkNrrdReader")) {
    std::vector<std::string> files = SeriesOf(reader, consumer);
    if (files.empty() && reader->GetFileName()) {
      files.emplace_back(reader->GetFileName());
    }
    return !std::all_of(files.begin(), files.end(), IsRawNrrd);
  }
  return reader && (reader->IsA("vtkMetaImageReader") || reader->IsA("vtkDICOMImageReader") ||
                    reader->IsA("vtkTGAReader"));
}

/// Of several processes: filters that must be executed in all of them at once and cut what is asked
/// for into a part for each. A single voxel cannot be cut so.
bool CutsForAllProcesses(vtkAlgorithm* algorithm) { return algorithm->IsA("vtkPResampleToImage"); }

/// The class of one that `test` says yes to; empty where there is none.
template <class Test> std::string FindUpstream(vtkAlgorithm* algorithm, const Test& test)
{
  for (vtkAlgorithm* source : UpstreamOf(algorithm)) {
    if (test(source)) {
      return source->GetClassName();
    }
  }
  return {};
}

} // namespace

std::string FindCollectiveFilter(vtkAlgorithm* algorithm)
{
  return FindUpstream(algorithm, CutsForAllProcesses);
}

std::string FindWholeFileReader(vtkAlgorithm* algorithm)
{
  return FindUpstream(algorithm,
                      [&](vtkAlgorithm* reader) { return GivesWholeFiles(reader, algorithm); });
}
