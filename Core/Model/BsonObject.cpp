// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/BsonObject.h"

#include "Core/Model/LittleEndian.h"

#include <limits>
#include <utility>

namespace inr {
namespace {

std::string LengthOf(std::size_t bytes) { return ToBytes(static_cast<std::int32_t>(bytes)); }

/// `elements` between their length and the end.
std::string AsDocument(const std::string& elements)
{
  return LengthOf(sizeof(std::int32_t) + elements.size() + 1) + elements + '\0';
}

} // namespace

std::string BsonElement(BsonType type, const std::string& key, const std::string& value)
{
  return static_cast<char>(type) + key + '\0' + value;
}

BsonObject& BsonObject::text(const std::string& key, const std::string& value)
{
  return this->set(key, BsonType::String, LengthOf(value.size() + 1) + value + '\0');
}

BsonObject& BsonObject::integer(const std::string& key, std::int64_t value)
{
  using Short = std::numeric_limits<std::int32_t>;
  return value >= Short::min() && value <= Short::max()
             ? this->set(key, BsonType::Int32, ToBytes(static_cast<std::int32_t>(value)))
             : this->set(key, BsonType::Int64, ToBytes(value));
}

BsonObject& BsonObject::real(const std::string& key, double value)
{
  return this->set(key, BsonType::Double, ToBytes(value));
}

BsonObject& BsonObject::flag(const std::string& key, bool value)
{
  return this->set(key, BsonType::Boolean, std::string(1, value ? '\x01' : '\x00'));
}

BsonObject& BsonObject::object(const std::string& key, const BsonObject& value)
{
  return this->set(key, BsonType::Object, value.bytes());
}

BsonObject& BsonObject::reals(const std::string& key, const std::vector<double>& values)
{
  std::string elements;
  for (std::size_t k = 0; k < values.size(); ++k) {
    elements += BsonElement(BsonType::Double, std::to_string(k), ToBytes(values[k]));
  }
  return this->set(key, BsonType::Array, AsDocument(elements));
}

BsonObject& BsonObject::emptyBinary(const std::string& key)
{
  return this->set(key, BsonType::Binary, LengthOf(0) + '\0'); // and the general subtype
}

std::string BsonObject::bytes() const
{
  std::string elements;
  for (const auto& [key, element] : this->Elements) {
    elements += BsonElement(element.type, key, element.value);
  }
  return AsDocument(elements);
}

BsonObject& BsonObject::set(const std::string& key, BsonType type, std::string value)
{
  this->Elements[key] = {type, std::move(value)};
  return *this;
}

} // namespace inr
