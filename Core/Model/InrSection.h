// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/BsonObject.h"
#include "Core/Model/JsonSection.h"
#include "Core/Model/Model.h"

#include <cstdint>
#include <optional>

namespace inr {

/// What the root key `inr` of our own files says; see FORMAT.md.
struct InrSection
{
  bool compact = false; ///< format version 2: quantised parameters, packed blobs
  VolumeInfo volume;
  std::optional<glm::i64vec3> nativeDims; ///< see Model
  HashRule rule = HashRule::Wrapping;
  MacroCellProvenance provenance = MacroCellProvenance::File;
  std::int64_t apron = 0;     ///< of macro-cells, in voxels
  std::uint32_t checksum = 0; ///< CRC-32 of the parameter blob followed by the macro-cell blob
  std::optional<Quality> quality;
  std::optional<TrainingRecord> training;
};

/// The format's version, of those that are known; Error(Unsupported) names another.
std::int64_t ParseVersion(const JsonSection& section);

/// Throws Error(Unsupported) for a later version or another transform, Error(InvalidModel) for
/// values out of range.
InrSection ParseInrSection(const JsonSection& section);

BsonObject OwnSection(const Model& model, std::uint32_t checksum);

/// The integers `x`, `y` and `z` of a section; unchecked.
glm::i64vec3 ParseDims(const JsonSection& section);
BsonObject DimsSection(const glm::i64vec3& dims);

} // namespace inr
