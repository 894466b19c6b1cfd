// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

class vtkAlgorithm;

/// Time steps that are going to be read, by number, and of how many; no numbers = the present
/// state.
struct StepsToRead
{
  std::vector<int> numbers;
  std::size_t available = 0;
};

/// The raw files that an algorithm's inputs are read from, as they are when this is made: nothing
/// in them tells when they become others.
class RawFiles
{
public:
  /// Of series of files those of the steps; all, where steps are not files.
  explicit RawFiles(vtkAlgorithm* algorithm, const StepsToRead& steps = {});

  /// Says what is wrong where one cannot be read, or is shorter than its reader was told: VTK's
  /// complains and gives what it has, and ParaView's, which takes what is too much for a header,
  /// tries for ever to read from before the beginning. Empty where nothing is wrong.
  const std::string& problem() const { return this->Problem; }

  /// The error, which names a file that has changed since, if one has.
  inr::Error complete(const inr::Error& error) const;

private:
  struct State
  {
    std::uintmax_t bytes;
    std::filesystem::file_time_type written;
  };
  using States = std::map<std::string, State>;

  void add(const std::string& path, std::uint64_t wanted);

  std::string Problem; ///< of the first that has one
  States Files;
};
