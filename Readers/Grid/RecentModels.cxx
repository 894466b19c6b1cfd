// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Grid/RecentModels.h"

#include <iterator>
#include <utility>

ModelSource& RecentModels::Select(const std::string& path, const inr::ModelOverrides& overrides)
{
  this->Find(path, overrides);
  this->Sources.splice(this->Sources.begin(), this->Sources, this->Places.at(path));
  this->Trim();
  return this->Sources.front();
}

ModelSource& RecentModels::Find(const std::string& path, const inr::ModelOverrides& overrides)
{
  const auto known = this->Places.find(path);
  if (known != this->Places.end()) {
    known->second->Select(path, overrides);
    return *known->second;
  }
  ModelSource source;
  source.Select(path, overrides);
  this->Sources.push_back(std::move(source));
  this->Places[path] = std::prev(this->Sources.end());
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
