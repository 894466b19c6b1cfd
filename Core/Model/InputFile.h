// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace inr {

/// A regular file of known size, read at any position. Throws Error(CannotRead) for anything else,
/// and when the file gets shorter meanwhile.
class InputFile
{
public:
  explicit InputFile(const std::string& path);
  /// One that is in memory.
  static InputFile OfBytes(std::string bytes) { return InputFile(std::move(bytes), InMemory{}); }
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::int64_t size() const { return this->Size; }

  /// Exactly `bytes` bytes from `offset` on, which must lie within the file.
  void read(std::int64_t offset, void* target, std::size_t bytes) const;

private:
  struct InMemory
  {};
  InputFile(std::string bytes, InMemory unused);

  std::string Bytes;
  int Descriptor = -1; ///< below 0: it is Bytes
  std::int64_t Size = 0;
};

} // namespace inr
