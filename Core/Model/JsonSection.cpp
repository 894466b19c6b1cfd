// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/JsonSection.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

using nlohmann::json;

std::string LowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

JsonSection::JsonSection(const json& object, std::string name)
    : Name(std::move(name)), Object(&object)
{
  if (!object.is_object()) {
    throw Error(ErrorCode::InvalidModel,
                (this->Name.empty() ? "the document" : "'" + this->Name + "'") +
                    " is not an object");
  }
}

JsonSection JsonSection::section(const char* key) const
{
  const std::string name = this->Name.empty() ? key : this->Name + "." + key;
  const json* value = this->find(key);
  return value == nullptr ? JsonSection(name) : JsonSection(*value, name);
}

std::int64_t JsonSection::integer(const char* key) const
{
  const json& value = this->require(key);
  constexpr auto Largest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= Largest) {
    return static_cast<std::int64_t>(value.get<std::uint64_t>());
  }
  if (value.is_number_integer() && !value.is_number_unsigned()) {
    return value.get<std::int64_t>();
  }
  constexpr double ExactLimit = 0x1p53;
  const double number = value.is_number_float() ? value.get<double>() : std::nan("");
  if (!(std::abs(number) <= ExactLimit) || number != std::floor(number)) {
    this->refuse(key, "must be an integer");
  }
  return static_cast<std::int64_t>(number);
}

std::int64_t JsonSection::integer(const char* key, std::int64_t fallback) const
{
  return this->has(key) ? this->integer(key) : fallback;
}

double JsonSection::number(const char* key) const
{
  const json& value = this->require(key);
  if (!value.is_number()) {
    this->refuse(key, "must be a number");
  }
  return value.get<double>();
}

double JsonSection::number(const char* key, double fallback) const
{
  return this->has(key) ? this->number(key) : fallback;
}

bool JsonSection::boolean(const char* key, bool fallback) const
{
  const json* value = this->find(key);
  if (value == nullptr) {
    return fallback;
  }
  if (!value->is_boolean()) {
    this->refuse(key, "must be true or false");
  }
  return value->get<bool>();
}

std::string JsonSection::text(const char* key) const
{
  const json& value = this->require(key);
  if (!value.is_string()) {
    this->refuse(key, "must be a string");
  }
  return value.get<std::string>();
}

void JsonSection::allowOnly(std::initializer_list<const char*> known) const
{
  if (this->Object == nullptr) {
    return;
  }
  for (const auto& item : this->Object->items()) {
    if (std::find(known.begin(), known.end(), item.key()) == known.end()) {
      std::string list;
      for (const char* key : known) {
        list += (list.empty() ? "" : ", ") + std::string(key);
      }
      this->refuse(item.key().c_str(), "is not known; what may be here is " + list);
    }
  }
}

void JsonSection::refuse(const char* key, const std::string& reason) const
{
  throw Error(ErrorCode::InvalidModel, this->nameOf(key) + " " + reason);
}

const json* JsonSection::find(const char* key) const
{
  if (this->Object == nullptr) {
    return nullptr;
  }
  const auto found = this->Object->find(key);
  return found == this->Object->end() ? nullptr : &*found;
}

std::string JsonSection::nameOf(const char* key) const
{
  return this->Name.empty() ? "'" + std::string(key) + "'" : "'" + this->Name + "." + key + "'";
}

const json& JsonSection::require(const char* key) const
{
  const json* value = this->find(key);
  if (value == nullptr) {
    this->refuse(key, "is missing");
  }
  return *value;
}

} // namespace inr
