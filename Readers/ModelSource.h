// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Model/ModelFile.h"

#include <cstdint>
#include <string>

/// A model file that is read again only when name, overrides or the file itself have changed.
class ModelSource
{
public:
  /// Which file with which corrections. Throws inr::Error(CannotRead) when it is not there.
  void Select(const std::string& path, const inr::ModelOverrides& overrides);

  /// Everything but parameters and macro-cells. Throws inr::Error.
  const inr::Model& Header();

  /// The whole model. Throws inr::Error.
  const inr::ModelPointer& Model();

  std::int64_t FileSize() const { return this->Size; }

private:
  std::string Path;
  inr::ModelOverrides Overrides;
  std::int64_t Time = 0;
  std::int64_t Size = 0;
  inr::Model LoadedHeader;
  bool HasHeader = false;
  inr::ModelPointer Loaded;
};
