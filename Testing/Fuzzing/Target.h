// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

/// What a fuzzer calls: returns 0 for any input, and ends the process where one gives a wrong
/// answer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// A promise that holds for every input.
#define INR_REQUIRE(condition)                                                                     \
  do {                                                                                             \
    if (!(condition)) {                                                                            \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                 \
      std::abort();                                                                                \
    }                                                                                              \
  } while (false)

/// A file in memory that has a path like any other.
class MemoryFile
{
public:
  MemoryFile(const void* data, std::size_t size) : Descriptor(memfd_create("fuzz", MFD_CLOEXEC))
  {
    const bool whole = write(this->Descriptor, data, size) == static_cast<ssize_t>(size);
    INR_REQUIRE(whole);
  }
  ~MemoryFile() { close(this->Descriptor); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(this->Descriptor); }

private:
  int Descriptor;
};
