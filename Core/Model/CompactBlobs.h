// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Compression.h"
#include "Core/Model/Document.h"
#include "Core/Model/InputFile.h"
#include "Core/Model/Model.h"

#include <cstdint>
#include <string>
#include <vector>

namespace inr {

// The blobs of a compact file: one zstd frame each, see FORMAT.md. Checksum and errors are as in
// ModelBlobs.h.

/// Bytes before packing: two of a parameter, two of a macro-cell.
std::int64_t PlainParameterBytes(std::uint64_t parameters);
std::int64_t PlainRangeBytes(std::int64_t cells);

/// Bytes that the blobs take at most.
std::int64_t LargestQuantised(const Description& description);
std::int64_t LargestCompactRanges(std::int64_t cells);

/// The parameters as multiples of `model.steps`. Throws Error(InvalidModel) for a value that is not
/// finite or not within 16 bits of its step, and for steps that are not one for each group.
std::string EncodeQuantised(const Model& model, Packing packing);

/// Whether a reader will unpack them; not more than 2^27 that are all too equal. Throws as
/// EncodeQuantised does, and takes as long where there are as many.
bool IsReadableQuantised(const Model& model);

/// The inverse, for a header with description and (valid) steps.
AlignedVector<float> DecodeQuantised(const InputFile& file, const Blob& blob, const Model& header,
                                     std::uint32_t& checksum);

/// Ranges in 8 bits a bound, rounded outwards by up to 1/255; the network's output never leaves
/// [0, 1], and so what lies outside is cut off.
std::string EncodeCompactRanges(const std::vector<ValueRange>& ranges, Packing packing);
std::vector<ValueRange> DecodeCompactRanges(const InputFile& file, const Blob& blob,
                                            std::int64_t cells, std::uint32_t& checksum);

} // namespace inr
