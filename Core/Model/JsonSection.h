// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>

namespace inr {

/// Names of an enumeration's values; the first name of a value is the one that is written.
template <typename Enum, std::size_t Count>
using NameTable = std::array<std::pair<const char*, Enum>, Count>;

template <typename Enum, std::size_t Count>
const char* NameOf(const NameTable<Enum, Count>& names, Enum value)
{
  for (const auto& [name, candidate] : names) {
    if (candidate == value) {
      return name;
    }
  }
  return "";
}

std::string LowerCase(std::string text); ///< of ASCII letters

/// A view of one JSON object that knows its name, so that every refusal names the key. Throws
/// Error(InvalidModel) for a value of the wrong kind, or for a missing one without a fallback. An
/// absent section answers every question with the fallback.
class JsonSection
{
public:
  JsonSection(const nlohmann::json& object, std::string name);

  bool present() const { return this->Object != nullptr; }
  bool has(const char* key) const { return this->find(key) != nullptr; }
  JsonSection section(const char* key) const;

  /// Doubles without a fraction count as integers: upstream copies what the user wrote.
  std::int64_t integer(const char* key) const;
  std::int64_t integer(const char* key, std::int64_t fallback) const;
  double number(const char* key) const;
  double number(const char* key, double fallback) const;
  bool boolean(const char* key, bool fallback) const;
  std::string text(const char* key) const;

  /// One of `names`, whatever the case; Error(Unsupported) lists them.
  template <typename Enum, std::size_t Count>
  Enum choice(const char* key, const NameTable<Enum, Count>& names, Enum fallback) const
  {
    return this->has(key) ? this->choice(key, names) : fallback;
  }

  template <typename Enum, std::size_t Count>
  Enum choice(const char* key, const NameTable<Enum, Count>& names) const
  {
    const std::string wanted = this->text(key);
    std::string supported;
    for (const auto& [name, value] : names) {
      if (LowerCase(wanted) == LowerCase(name)) {
        return value;
      }
      supported += (supported.empty() ? "" : ", ") + std::string(name);
    }
    throw Error(ErrorCode::Unsupported,
                this->nameOf(key) + " is '" + wanted + "'; supported are " + supported);
  }

  /// Refuses a key that is none of `known`, which it lists.
  void allowOnly(std::initializer_list<const char*> known) const;

  [[noreturn]] void refuse(const char* key, const std::string& reason) const;

  /// The value itself, or nullptr.
  const nlohmann::json* find(const char* key) const;

private:
  explicit JsonSection(std::string name) : Name(std::move(name)) {}

  std::string nameOf(const char* key) const;
  const nlohmann::json& require(const char* key) const;

  std::string Name;
  const nlohmann::json* Object = nullptr;
};

} // namespace inr
