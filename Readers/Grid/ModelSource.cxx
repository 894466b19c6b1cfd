// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Grid/ModelSource.h"

#include "Core/Error.h"
#include "Core/Model/ScaledModel.h"

#include <cerrno>
#include <sys/stat.h>
#include <system_error>
#include <utility>

namespace {

bool IsSameVolume(const inr::VolumeInfo& a, const inr::VolumeInfo& b)
{
  return a.dims == b.dims && a.spacing == b.spacing && a.origin == b.origin &&
         a.direction == b.direction && a.type == b.type && a.low == b.low && a.high == b.high &&
         a.arrayName == b.arrayName;
}

} // namespace

ModelSource::FileStamp ModelSource::StampOf(const std::string& path)
{
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) {
    throw inr::Error(inr::ErrorCode::CannotRead,
                     "cannot read '" + path + "': " + std::generic_category().message(errno));
  }
  return {status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size};
}

void ModelSource::Select(const std::string& path, const inr::ModelOverrides& overrides)
{
  const FileStamp stamp = StampOf(path);
  const bool same = path == this->Path && stamp == this->File &&
                    overrides.dims == this->Overrides.dims &&
                    overrides.dataRange == this->Overrides.dataRange;
  if (!same) {
    *this = ModelSource();
    this->Path = path;
    this->Overrides = overrides;
    this->File = stamp;
  }
}

void ModelSource::Scale(double factor)
{
  if (factor != this->Factor) {
    this->Factor = factor;
    this->Scaled = nullptr;
    this->Kept = nullptr;
  }
}

const inr::Model& ModelSource::Header()
{
  if (!this->LoadedHeader) {
    this->LoadedHeader = inr::ReadModelHeader(this->Path, this->Overrides);
  }
  return *this->LoadedHeader;
}

inr::VolumeInfo ModelSource::Volume()
{
  return inr::ScaledVolume(this->Header().volume, this->Factor);
}

const inr::ModelPointer& ModelSource::Model()
{
  if (!this->Loaded) {
    inr::ModelPointer loaded = inr::ReadModel(this->Path, this->Overrides);
    // What was told of the grid and its values is the header's, of an earlier reading.
    if (!IsSameVolume(loaded->volume, this->Header().volume)) {
      throw inr::Error(inr::ErrorCode::CannotRead, "'" + this->Path +
                                                       "' has become another file while it was "
                                                       "being opened; open it again");
    }
    this->Loaded = std::move(loaded);
  }
  if (!this->Scaled) {
    this->Scaled = inr::ScaledModel(this->Loaded, this->Factor);
  }
  return this->Scaled;
}

const std::shared_ptr<vtkINRDataArray::Keepsake>& ModelSource::Keepsake()
{
  if (!this->Kept) {
    this->Kept = std::make_shared<vtkINRDataArray::Keepsake>();
  }
  return this->Kept;
}

std::int64_t ModelSource::MemorySize() const
{
  const auto bytes = [](const inr::ModelPointer& model) {
    return model ? model->parameters.size() * sizeof(float) +
                       model->macroCells.ranges.size() * sizeof(inr::ValueRange)
                 : 0;
  };
  const bool scaledIsOther = this->Scaled != this->Loaded;
  return static_cast<std::int64_t>(bytes(this->Loaded) + (scaledIsOther ? bytes(this->Scaled) : 0));
}

void ModelSource::Unload()
{
  this->Loaded = nullptr;
  this->Scaled = nullptr;
  this->Kept = nullptr;
}
