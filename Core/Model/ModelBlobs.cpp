// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/ModelBlobs.h"

#include "Core/Error.h"
#include "Core/Model/LittleEndian.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <zlib.h>

namespace inr {
namespace {

static_assert(sizeof(ValueRange) == 8, "a range is two floats, in memory as in the file");

constexpr std::int64_t ChunkSize = 1 << 20;

// Calls `body(bytes, begin, size)` for consecutive pieces of the blob.
template <typename Body>
void ForEachChunk(const InputFile& file, const Blob& blob, const Body& body)
{
  std::vector<std::uint8_t> chunk(static_cast<std::size_t>(std::min(ChunkSize, blob.size)));
  for (std::int64_t begin = 0; begin < blob.size; begin += ChunkSize) {
    const auto size = static_cast<std::size_t>(std::min(ChunkSize, blob.size - begin));
    if (blob.inMemory) {
      body(blob.bytes.data() + begin, begin, size);
    } else {
      file.read(blob.offset + begin, chunk.data(), size);
      body(chunk.data(), begin, size);
    }
  }
}

template <typename T>
void AppendFloats(AlignedVector<float>& values, const std::uint8_t* bytes, std::size_t size)
{
  for (std::size_t at = 0; at < size; at += sizeof(T)) {
    const T stored = FromBytes<T>(bytes + at);
    if constexpr (sizeof(T) == 2) {
      values.push_back(imath_half_to_float(stored));
    } else {
      values.push_back(stored);
    }
  }
}

[[noreturn]] void RefuseNonFinite(const char* what, const Blob& blob, std::size_t index,
                                  std::size_t elementSize)
{
  const auto position = static_cast<std::int64_t>(index * elementSize);
  throw Error(ErrorCode::InvalidModel,
              std::string(what) + " " + std::to_string(index) + " is not a finite number",
              blob.inMemory ? Error::NoOffset : blob.offset + position);
}

bool IsZero(const ValueRange& stored) { return stored.low == 0 && stored.high == 0; }

// Upstream's writers disagree, and the two encodings meet in (0, 1) only, which as an offset would
// be an inverted range. Zeros are left out: untouched cells of the one, valid ranges of the other.
bool IsOffset(const std::vector<ValueRange>& stored)
{
  return std::any_of(stored.begin(), stored.end(), [](const ValueRange& range) {
    return !IsZero(range) && (range.low < 0 || range.high > 1);
  });
}

ValueRange Normalised(float low, float high)
{
  return low > high ? ValueRange{} : ValueRange{low, high};
}

ValueRange FromOffset(const ValueRange& stored)
{
  return IsZero(stored) ? ValueRange{} : Normalised(stored.low + 1.0f, stored.high - 1.0f);
}

ValueRange Clamped(const ValueRange& range)
{
  const auto clamp = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
  return range.empty() ? range : ValueRange{clamp(range.low), clamp(range.high)};
}

// Upstream's values are normalised data, so anything outside [0, 1] is rounding.
void DecodeDetected(std::vector<ValueRange>& ranges)
{
  if (std::all_of(ranges.begin(), ranges.end(), IsZero)) {
    ranges.clear();
    return;
  }
  const bool offset = IsOffset(ranges);
  for (ValueRange& range : ranges) {
    range = Clamped(offset ? FromOffset(range) : Normalised(range.low, range.high));
  }
}

ValueRange ToOffset(const ValueRange& range)
{
  constexpr float Infinity = std::numeric_limits<float>::infinity();
  if (range.empty()) {
    return {0.0f, 0.0f};
  }
  ValueRange stored{range.low - 1.0f, range.high + 1.0f};
  while (stored.low + 1.0f > range.low) {
    stored.low = std::nextafter(stored.low, -Infinity);
  }
  while (stored.high - 1.0f < range.high) {
    stored.high = std::nextafter(stored.high, Infinity);
  }
  return stored;
}

std::uint16_t ToHalf(float value, std::size_t index)
{
  const std::uint16_t half = imath_float_to_half(value);
  if (!std::isfinite(imath_half_to_float(half))) {
    throw Error(ErrorCode::InvalidModel, "parameter " + std::to_string(index) + " is " +
                                             std::to_string(value) +
                                             ", which half precision cannot hold; store the model "
                                             "in single precision");
  }
  return half;
}

template <typename Vector> std::string BytesOf(const Vector& values)
{
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

} // namespace

std::size_t ParameterSize(ParameterType type)
{
  switch (type) {
  case ParameterType::Half:
    return sizeof(std::uint16_t);
  case ParameterType::Float:
    return sizeof(float);
  default:
    throw Error(ErrorCode::InvalidArgument, "quantised parameters have no size of their own");
  }
}

AlignedVector<float> DecodeParameters(const InputFile& file, const Blob& blob, ParameterType type,
                                      std::uint32_t& checksum)
{
  const std::size_t size = ParameterSize(type);
  AlignedVector<float> values;
  values.reserve(static_cast<std::size_t>(blob.size) / size);
  ForEachChunk(file, blob, [&](const std::uint8_t* bytes, std::int64_t, std::size_t count) {
    checksum = ContinueChecksum(checksum, bytes, count);
    const std::size_t first = values.size();
    type == ParameterType::Half ? AppendFloats<std::uint16_t>(values, bytes, count)
                                : AppendFloats<float>(values, bytes, count);
    for (std::size_t i = first; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) {
        RefuseNonFinite("parameter", blob, i, size);
      }
    }
  });
  return values;
}

std::vector<ValueRange> DecodeRanges(const InputFile& file, const Blob& blob, CellEncoding encoding,
                                     std::uint32_t& checksum)
{
  std::vector<ValueRange> ranges;
  ranges.reserve(static_cast<std::size_t>(blob.size) / sizeof(ValueRange));
  ForEachChunk(file, blob, [&](const std::uint8_t* bytes, std::int64_t, std::size_t count) {
    checksum = ContinueChecksum(checksum, bytes, count);
    for (std::size_t at = 0; at < count; at += sizeof(ValueRange)) {
      const ValueRange stored{FromBytes<float>(bytes + at), FromBytes<float>(bytes + at + 4)};
      if (!std::isfinite(stored.low) || !std::isfinite(stored.high)) {
        RefuseNonFinite("macro-cell range", blob, ranges.size(), sizeof(ValueRange));
      }
      ranges.push_back(stored);
    }
  });
  if (encoding == CellEncoding::Offset) {
    std::transform(ranges.begin(), ranges.end(), ranges.begin(), FromOffset);
  } else {
    DecodeDetected(ranges);
  }
  return ranges;
}

std::string EncodeParameters(const AlignedVector<float>& parameters, ParameterType type)
{
  std::vector<std::uint16_t> halves;
  halves.reserve(type == ParameterType::Half ? parameters.size() : 0);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!std::isfinite(parameters[i])) {
      throw Error(ErrorCode::InvalidModel,
                  "parameter " + std::to_string(i) + " is not a finite number");
    }
    if (type == ParameterType::Half) {
      halves.push_back(ToHalf(parameters[i], i));
    }
  }
  return type == ParameterType::Half ? BytesOf(halves) : BytesOf(parameters);
}

std::string EncodeRanges(const std::vector<ValueRange>& ranges)
{
  std::vector<ValueRange> stored;
  stored.reserve(ranges.size());
  for (const ValueRange& range : ranges) {
    RequireFiniteRange(range, stored.size());
    stored.push_back(ToOffset(range));
  }
  return BytesOf(stored);
}

void RequireFiniteRange(const ValueRange& range, std::size_t index)
{
  if (!std::isfinite(range.low) || !std::isfinite(range.high)) {
    throw Error(ErrorCode::InvalidModel,
                "macro-cell range " + std::to_string(index) + " is not finite");
  }
}

std::uint32_t ContinueChecksum(std::uint32_t checksum, const void* data, std::size_t bytes)
{
  return static_cast<std::uint32_t>(crc32_z(checksum, static_cast<const Bytef*>(data), bytes));
}

} // namespace inr
