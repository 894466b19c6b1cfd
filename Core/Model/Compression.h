// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace inr {

/// For a file, which is written once; or in a thirtieth of the time, and a tenth larger, for bytes
/// that somebody waits for.
enum class Packing { Small, Fast };

/// `bytes` as one zstd frame (RFC 8878). A block of it, with code lengths of its own, ends at each
/// of `boundaries`, which rise: they part bytes that are distributed differently. The same bytes
/// give the same frame on any machine with the same zstd. Takes about a second for 6 MB.
std::string Compress(const std::string& bytes, const std::vector<std::size_t>& boundaries = {},
                     Packing packing = Packing::Small);

/// Bytes that `Compress` makes of so many at most.
std::int64_t CompressedBound(std::int64_t bytes, std::size_t boundaries = 0);

/// Whether a file may claim that `compressed` bytes stand for `plain` ones. Up to 256 MiB any ratio
/// is accepted (constant data pack at 30,000:1), beyond that 64:1, so that a small file cannot ask
/// for all of the memory.
bool MayExpand(std::int64_t compressed, std::int64_t plain);

/// The `expected` bytes that one zstd frame stands for; what it says of its size itself is not
/// believed. Throws Error(InvalidModel) "the packed `what` ..." for anything else.
std::unique_ptr<std::uint8_t[]> Decompress(const std::string& frame, std::int64_t expected,
                                           const char* what);

} // namespace inr
