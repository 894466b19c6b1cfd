// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Readers/Grid/ModelSource.h"

#include <cstdint>
#include <list>
#include <string>
#include <unordered_map>

/// The model files that a reader has opened, one for each time step: going back to one loads
/// nothing as long as the file is the same. Of those not shown at present, models stay in memory
/// within a limit, the latest ones.
class RecentModels
{
public:
  /// `most`: bytes.
  explicit RecentModels(std::int64_t most) : Most(most) {}

  /// The file to be shown now; stays valid. Throws what ModelSource::Select throws.
  ModelSource& Select(const std::string& path, const inr::ModelOverrides& overrides);

  /// The same to look at its header only.
  ModelSource& Find(const std::string& path, const inr::ModelOverrides& overrides);

private:
  void Trim();

  std::int64_t Most;
  std::list<ModelSource> Sources; ///< the latest first
  /// By path: a series of thousands of files looks for each of them whenever it is asked about.
  std::unordered_map<std::string, std::list<ModelSource>::iterator> Places;
};
