// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Document.h"
#include "Core/Model/InputFile.h"
#include "Core/Model/JsonSection.h"
#include "Core/Model/Model.h"

#include <cstdint>
#include <string>
#include <vector>

namespace inr {

constexpr NameTable<ParameterType, 3> ParameterTypeNames = {
    {{"__half", ParameterType::Half},
     {"float", ParameterType::Float},
     {"quantised", ParameterType::Quantised}}};

std::size_t ParameterSize(ParameterType type); ///< bytes; throws for Quantised

/// How a file spells macro-cell ranges; see FORMAT.md.
enum class CellEncoding {
  Offset, ///< (low - 1, high + 1), and (0, 0) is an empty cell
  Detect  ///< that, or plain (low, high): upstream's files do not say
};

/// Bytes of a file's blobs as values; `checksum` is continued over the bytes. The blob's size must
/// be right already. Throw Error(InvalidModel) with the byte for a value that is not finite.
AlignedVector<float> DecodeParameters(const InputFile& file, const Blob& blob, ParameterType type,
                                      std::uint32_t& checksum);
/// Empty when the ranges tell nothing: a file of unknown encoding with nothing but zeros.
std::vector<ValueRange> DecodeRanges(const InputFile& file, const Blob& blob, CellEncoding encoding,
                                     std::uint32_t& checksum);

/// The inverse. Throw Error(InvalidModel) for a value that is not finite or that half precision
/// cannot hold. A range is rounded outwards, so that what is read back contains it.
std::string EncodeParameters(const AlignedVector<float>& parameters, ParameterType type);
std::string EncodeRanges(const std::vector<ValueRange>& ranges);

/// Throws Error(InvalidModel) unless both ends are finite.
void RequireFiniteRange(const ValueRange& range, std::size_t index);

/// CRC-32 as in zlib, continued from `checksum` (0 at the start).
std::uint32_t ContinueChecksum(std::uint32_t checksum, const void* data, std::size_t bytes);

} // namespace inr
