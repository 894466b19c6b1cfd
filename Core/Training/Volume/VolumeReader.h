// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Volume/Volume.h"

#include <glm/gtc/type_precision.hpp>

namespace inr {

/// A volume that is read in pieces, since it may be larger than memory.
class VolumeReader
{
public:
  virtual ~VolumeReader() = default;

  virtual const glm::i64vec3& dims() const = 0; ///< voxels per axis
  virtual ScalarType type() const = 0;

  /// That read() makes the source hold, which may have other arrays.
  virtual std::int64_t bytesPerVoxel() const
  {
    return static_cast<std::int64_t>(ScalarSize(this->type()));
  }

  /// Voxels around a box that read() asks its source for, too, where the volume has these.
  virtual int margin() const { return 0; }

  /// The voxels of a box within the volume, good until the next call. Called by one thread, the
  /// one that asked for the training. Throws what the application has to say when it fails.
  virtual VolumePiece read(const GridBox& box) = 0;
};

} // namespace inr
