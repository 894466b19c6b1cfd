// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Compression.h"

#include "Core/Error.h"

#include <zstd.h>

#include <algorithm>
#include <new>

namespace inr {
namespace {

// The highest level without an extra window; lower ones are no faster where it matters, on what
// hardly repeats itself, and leave up to 4 % more.
constexpr int Level = 19;

} // namespace

std::int64_t CompressedBound(std::int64_t bytes)
{
  return static_cast<std::int64_t>(ZSTD_compressBound(static_cast<std::size_t>(bytes)));
}

std::string Compress(const std::string& bytes)
{
  std::string frame(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(frame.data(), frame.size(), bytes.data(), bytes.size(), Level);
  if (ZSTD_isError(size) != 0) { // with room for the worst case, only memory can be missing
    throw std::bad_alloc();
  }
  frame.resize(size);
  return frame;
}

bool MayExpand(std::int64_t compressed, std::int64_t plain)
{
  constexpr std::int64_t anyRatio = std::int64_t{1} << 28;
  constexpr std::int64_t largestRatio = 64;
  return plain <= std::max(anyRatio, compressed * largestRatio);
}

std::unique_ptr<std::uint8_t[]> Decompress(const std::string& frame, std::int64_t expected,
                                           const char* what)
{
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::InvalidModel, std::string("the packed ") + what + " " + why);
  };
  // More frames, or other bytes, behind the first would be read as well.
  if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
    refuse("are not one zstd frame");
  }
  const auto size = static_cast<std::size_t>(expected);
  // Not set to zero: memory is taken as it is filled, which stops where a frame is broken.
  std::unique_ptr<std::uint8_t[]> plain(new std::uint8_t[size]);
  const std::size_t found = ZSTD_decompress(plain.get(), size, frame.data(), frame.size());
  if (ZSTD_isError(found) != 0) {
    refuse(std::string("cannot be unpacked to ") + std::to_string(expected) +
           " bytes: " + ZSTD_getErrorName(found));
  }
  if (found != size) {
    refuse("hold " + std::to_string(found) + " bytes instead of " + std::to_string(expected));
  }
  return plain;
}

} // namespace inr
