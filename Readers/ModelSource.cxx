// SPDX-License-Identifier: BSD-3-Clause
#include "ModelSource.h"

#include "Core/Error.h"

#include <filesystem>
#include <system_error>

namespace fs = std::filesystem;

void ModelSource::Select(const std::string& path, const inr::ModelOverrides& overrides)
{
  std::error_code problem;
  const auto time = fs::last_write_time(path, problem);
  // A folder or a device has a time but no size; reading it tells what is wrong.
  std::error_code noSize;
  const auto size = fs::file_size(path, noSize);
  if (problem) {
    throw inr::Error(inr::ErrorCode::CannotRead, path + ": " + problem.message());
  }

  const std::int64_t ticks = time.time_since_epoch().count();
  const std::int64_t bytes = noSize ? 0 : static_cast<std::int64_t>(size);
  const bool same = path == this->Path && ticks == this->Time && bytes == this->Size &&
                    overrides.dims == this->Overrides.dims &&
                    overrides.dataRange == this->Overrides.dataRange;
  if (!same) {
    *this = ModelSource();
    this->Path = path;
    this->Overrides = overrides;
    this->Time = ticks;
    this->Size = bytes;
  }
}

const inr::Model& ModelSource::Header()
{
  if (!this->HasHeader) {
    this->LoadedHeader = inr::ReadModelHeader(this->Path, this->Overrides);
    this->HasHeader = true;
  }
  return this->LoadedHeader;
}

const inr::ModelPointer& ModelSource::Model()
{
  if (!this->Loaded) {
    this->Loaded = inr::ReadModel(this->Path, this->Overrides);
  }
  return this->Loaded;
}
