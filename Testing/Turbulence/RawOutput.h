// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Testing/Turbulence/TurbulentChannel.h"

#include <glm/gtc/type_precision.hpp>

#include <cstdint>
#include <string>

namespace inr {

/// A volume of the field as a file of nothing but its voxels, x fastest.
struct RawVolumeFile
{
  glm::i64vec3 dims{0};
  bool doubles = false; ///< float64 instead of float32
  bool bigEndian = false;
  std::int64_t blockBytes = 32 << 20; ///< computed and written at once, at least a row

  std::int64_t bytes() const { return this->dims.x * this->dims.y * this->dims.z * this->scalar(); }
  std::int64_t scalar() const { return this->doubles ? 8 : 4; }
};

/// Writes `path`.raw, then `path`.mhd (MetaImage), which ParaView opens; each is there whole or not
/// at all. Nothing is written when the disk has no room for both. SIGINT and SIGTERM stop it.
/// Throws Error(CannotWrite) or Error(Cancelled).
void WriteRawVolume(const TurbulentChannel& field, const RawVolumeFile& file,
                    const std::string& path);

/// The voxels on standard output. Throws Error(CannotWrite).
void StreamRawVolume(const TurbulentChannel& field, const RawVolumeFile& file);

} // namespace inr
