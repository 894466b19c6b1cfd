// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/BsonTypes.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace inr {

/// The bytes of an element whose value's are `value`.
std::string BsonElement(BsonType type, const std::string& key, const std::string& value);

/// A BSON document to be written: keys in byte order, and whole numbers as short as they fit, as
/// upstream's library has them. That library's own values take memory to be destroyed, and end the
/// process where there is none; these do not. A value under a key that is there takes its place.
class BsonObject
{
public:
  BsonObject& text(const std::string& key, const std::string& value);
  BsonObject& integer(const std::string& key, std::int64_t value);
  BsonObject& real(const std::string& key, double value);
  BsonObject& flag(const std::string& key, bool value);
  BsonObject& object(const std::string& key, const BsonObject& value);
  BsonObject& reals(const std::string& key, const std::vector<double>& values);
  /// Of 0 bytes.
  BsonObject& emptyBinary(const std::string& key);

  std::string bytes() const;

private:
  struct Element
  {
    BsonType type;
    std::string value;
  };
  BsonObject& set(const std::string& key, BsonType type, std::string value);

  std::map<std::string, Element> Elements;
};

} // namespace inr
