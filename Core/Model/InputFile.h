// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace inr {

/// A regular file of known size, read at any position. Throws Error(CannotRead) for anything else,
/// and when the file gets shorter meanwhile.
class InputFile
{
public:
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::int64_t size() const { return this->Size; }

  /// Exactly `bytes` bytes from `offset` on, which must lie within the file.
  void read(std::int64_t offset, void* target, std::size_t bytes) const;

private:
  int Descriptor = -1;
  std::int64_t Size = 0;
};

} // namespace inr
