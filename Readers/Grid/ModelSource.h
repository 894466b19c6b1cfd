// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Model/ModelFile.h"
#include "vtkINRDataArray.h"

#include <cstdint>
#include <optional>
#include <string>

/// A model file that is read again only when name, overrides or the file itself have changed, on a
/// grid that is not the file's own when a factor says so.
class ModelSource
{
public:
  /// Which file with which corrections. Throws inr::Error(CannotRead) when it is not there.
  void Select(const std::string& path, const inr::ModelOverrides& overrides);

  /// Of the selected file; see inr::ScaledVolume. 1 after a new selection.
  void Scale(double factor);

  /// Everything but parameters and macro-cells, not scaled. Throws inr::Error.
  const inr::Model& Header();

  /// The scaled volume. Throws inr::Error.
  inr::VolumeInfo Volume();

  /// The whole model, scaled. Throws inr::Error, also where it is not the header's any more.
  const inr::ModelPointer& Model();

  /// Goes with Model(): another one for another model.
  const std::shared_ptr<vtkINRDataArray::Keepsake>& Keepsake();

  std::int64_t FileSize() const { return this->File.size; }

  /// Bytes of the models in memory.
  std::int64_t MemorySize() const;
  /// Forgets the models, and what was kept with them, but not the header.
  void Unload();

private:
  /// Tells versions of a file apart. A file that is replaced within one tick of the clock has
  /// another number.
  struct FileStamp
  {
    std::uint64_t number = 0;
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0;
    std::int64_t size = 0;

    bool operator==(const FileStamp& other) const
    {
      return this->number == other.number && this->seconds == other.seconds &&
             this->nanoseconds == other.nanoseconds && this->size == other.size;
    }
  };
  static FileStamp StampOf(const std::string& path);

  std::string Path;
  inr::ModelOverrides Overrides;
  FileStamp File;
  std::optional<inr::Model> LoadedHeader;
  inr::ModelPointer Loaded;
  double Factor = 1;
  inr::ModelPointer Scaled;
  std::shared_ptr<vtkINRDataArray::Keepsake> Kept; ///< with Scaled
};
