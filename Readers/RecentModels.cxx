// SPDX-License-Identifier: BSD-3-Clause
#include "RecentModels.h"

#include <algorithm>

ModelSource& RecentModels::Select(const std::string& path, const inr::ModelOverrides& overrides)
{
  const ModelSource* const source = &this->Find(path, overrides);
  const auto found = std::find_if(this->Sources.begin(), this->Sources.end(),
                                  [&](const ModelSource& other) { return &other == source; });
  this->Sources.splice(this->Sources.begin(), this->Sources, found);
  this->Trim();
  return this->Sources.front();
}

ModelSource& RecentModels::Find(const std::string& path, const inr::ModelOverrides& overrides)
{
  const auto found =
      std::find_if(this->Sources.begin(), this->Sources.end(),
                   [&](const ModelSource& other) { return other.GetPath() == path; });
  if (found != this->Sources.end()) {
    found->Select(path, overrides);
    return *found;
  }
  ModelSource source;
  source.Select(path, overrides);
  this->Sources.push_back(std::move(source));
  return this->Sources.back();
}

void RecentModels::Trim()
{
  std::int64_t others = 0;
  for (auto source = std::next(this->Sources.begin()); source != this->Sources.end(); ++source) {
    others += source->MemorySize();
    if (others > this->Most) {
      others -= source->MemorySize();
      source->Unload();
    }
  }
}
