// SPDX-License-Identifier: BSD-3-Clause
//
// What is read and written of BSON: https://bsonspec.org/spec.html
#pragma once

#include <cstdint>
#include <limits>

namespace inr {

/// The byte in front of an element.
enum class BsonType : std::uint8_t {
  EndOfDocument = 0x00,
  Double = 0x01,
  String = 0x02,
  Object = 0x03,
  Array = 0x04,
  Binary = 0x05,
  Boolean = 0x08,
  Null = 0x0A,
  Int32 = 0x10,
  Int64 = 0x12
};

/// Bytes of a document, which begins with their number; models in text form are no larger.
constexpr std::int64_t MostBsonBytes = std::numeric_limits<std::int32_t>::max();

} // namespace inr
