// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/RawFiles.h"

#include "Readers/Training/Upstream.h"

#include <vtkDataArray.h>
#include <vtkImageReader2.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <vector>

namespace {

/// No file has more bytes.
constexpr double MostBytes = 9e18;

/// Bytes of the values that a reader of one raw file was told of; 0 for any other reader.
std::uint64_t RawBytes(vtkImageReader2* reader)
{
  const std::string name = reader->GetClassName();
  const bool raw = name == "vtkImageReader" || name == "vtkMPIImageReader";
  if (!raw || !reader->GetFileName() || reader->GetFileDimensionality() != 3) {
    return 0;
  }
  double bytes = static_cast<double>(reader->GetNumberOfScalarComponents()) *
                 vtkDataArray::GetDataTypeSize(reader->GetDataScalarType());
  const int* extent = reader->GetDataExtent();
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t voxels = std::int64_t{extent[2 * axis + 1]} - extent[2 * axis] + 1;
    bytes *= static_cast<double>(std::max<std::int64_t>(voxels, 0));
  }
  return static_cast<std::uint64_t>(std::min(bytes, MostBytes)); // exact up to 2^53
}

std::vector<std::string> FilesOf(vtkImageReader2* reader, const std::vector<std::string>& series,
                                 const StepsToRead& steps)
{
  if (steps.numbers.empty() || series.empty()) {
    return {reader->GetFileName()};
  }
  if (series.size() != steps.available) { // some filter has made other steps of them
    return series;
  }
  std::vector<std::string> files;
  for (const int number : steps.numbers) {
    files.push_back(series[static_cast<std::size_t>(number)]);
  }
  return files;
}

} // namespace

RawFiles::RawFiles(vtkAlgorithm* algorithm, const StepsToRead& steps)
{
  for (vtkAlgorithm* other : UpstreamOf(algorithm)) {
    auto* reader = vtkImageReader2::SafeDownCast(other);
    const std::uint64_t wanted = reader ? RawBytes(reader) : 0;
    if (wanted == 0) {
      continue;
    }
    for (const std::string& file : FilesOf(reader, SeriesOf(reader, algorithm), steps)) {
      this->add(file, wanted);
    }
  }
}

void RawFiles::add(const std::string& path, std::uint64_t wanted)
{
  std::error_code noFile; // of what is no plain file
  const std::uintmax_t bytes = std::filesystem::file_size(path, noFile);
  std::error_code unknown;
  std::string problem;
  if (std::filesystem::is_directory(path, unknown) || !std::ifstream(path)) {
    problem = "cannot be opened for reading";
  } else if (!noFile && bytes < wanted) {
    problem = "has " + std::to_string(bytes) +
              " bytes, and the reader's DataExtent, DataScalarType and NumberOfScalarComponents "
              "ask for " +
              std::to_string(wanted) + "; correct these, or the file is incomplete";
  } else {
    this->Files[path] = {bytes, std::filesystem::last_write_time(path, unknown)};
  }
  if (!problem.empty() && this->Problem.empty()) {
    this->Problem = "'" + path + "' " + problem;
  }
}

inr::Error RawFiles::complete(const inr::Error& error) const
{
  for (const auto& [path, before] : this->Files) {
    std::error_code gone;
    const std::uintmax_t bytes = std::filesystem::file_size(path, gone);
    const auto written = std::filesystem::last_write_time(path, gone);
    if (!gone && bytes == before.bytes && written == before.written) {
      continue;
    }
    std::string text = error.what();
    if (text.find(path) != std::string::npos) {
      return error;
    }
    text.append("; '").append(path).append("' has been ");
    text.append(gone ? "removed" : "replaced or written to").append(" since it was read first");
    return inr::Error(error.code(), text);
  }
  return error;
}
