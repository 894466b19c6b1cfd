// SPDX-License-Identifier: BSD-3-Clause
//
// A volume from a file of nothing but its voxels, x fastest, for programs that scripts run.
#pragma once

#include "Core/Error.h"
#include "Core/Training/Volume/Volume.h"

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

class RawVolume
{
public:
  /// `arguments`: path, type ("uint8", ..., "float64") and voxels per axis. Throws inr::Error when
  /// the file does not hold as many values.
  explicit RawVolume(char* const* arguments)
  {
    const auto type = inr::ScalarFromName(arguments[1]);
    std::ifstream file(arguments[0], std::ios::binary);
    this->Bytes.assign(std::istreambuf_iterator<char>(file), {});
    this->Data.dims = {std::stoll(arguments[2]), std::stoll(arguments[3]),
                       std::stoll(arguments[4])};
    this->Data.type = type.value_or(inr::ScalarType::UInt8);
    this->Data.values = this->Bytes.data();
    if (!type || this->Bytes.size() != this->bytes()) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       std::string(arguments[0]) + " does not hold the voxels that were named");
    }
  }
  RawVolume(const RawVolume&) = delete;
  RawVolume& operator=(const RawVolume&) = delete;

  const inr::VolumeData& data() const { return this->Data; }
  std::size_t bytes() const
  {
    return static_cast<std::size_t>(this->Data.voxels()) * inr::ScalarSize(this->Data.type);
  }

private:
  std::vector<char> Bytes;
  inr::VolumeData Data;
};
