// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/InputFile.h"

#include "Core/Error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace inr {
namespace {

[[noreturn]] void FailToRead(int reason)
{
  throw Error(ErrorCode::CannotRead, std::generic_category().message(reason));
}

} // namespace

InputFile::InputFile(const std::string& path)
{
  // O_NONBLOCK: a named pipe must not hang the caller before it is recognised as one.
  this->Descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (this->Descriptor < 0) {
    FailToRead(errno);
  }
  struct stat status
  {};
  const int failure = fstat(this->Descriptor, &status) != 0 ? errno
                      : S_ISDIR(status.st_mode)             ? EISDIR
                      : !S_ISREG(status.st_mode)            ? EINVAL
                                                            : 0;
  if (failure != 0) {
    close(this->Descriptor);
    FailToRead(failure);
  }
  this->Size = status.st_size;
}

InputFile::InputFile(std::string bytes, InMemory /*unused*/)
    : Bytes(std::move(bytes)), Size(static_cast<std::int64_t>(this->Bytes.size()))
{}

InputFile::~InputFile()
{
  if (this->Descriptor >= 0) {
    close(this->Descriptor);
  }
}

void InputFile::read(std::int64_t offset, void* target, std::size_t bytes) const
{
  if (this->Descriptor < 0) {
    if (offset + static_cast<std::int64_t>(bytes) > this->Size) {
      throw Error(ErrorCode::CannotRead, "the bytes end early", this->Size);
    }
    std::memcpy(target, this->Bytes.data() + offset, bytes);
    return;
  }
  char* next = static_cast<char*>(target);
  while (bytes > 0) {
    const ssize_t got = pread(this->Descriptor, next, bytes, offset);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      FailToRead(errno);
    }
    if (got == 0) {
      throw Error(ErrorCode::CannotRead, "the file ends early", offset);
    }
    next += got;
    offset += got;
    bytes -= static_cast<std::size_t>(got);
  }
}

} // namespace inr
