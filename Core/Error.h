// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace inr {

/// What went wrong, in categories a caller can act on.
enum class ErrorCode {
  CannotRead,      ///< missing file, no permission, read error
  CannotWrite,     ///< unwritable target, disk full
  Malformed,       ///< not a model file, truncated, or structurally broken
  Unsupported,     ///< well-formed, but uses something this program does not do
  InvalidModel,    ///< a description or parameter vector that contradicts itself
  InvalidArgument, ///< a value outside its documented range
  TooLarge,        ///< beyond a documented limit
  Cancelled,       ///< stopped on the user's request
  Device           ///< no GPU that can be used, its memory is short, or it failed
};

/// All that Core throws, but for std::bad_alloc where memory runs out in the midst of something.
/// `what()` says what, where and, where possible, what to do. It never crosses the VTK border.
class Error : public std::runtime_error
{
public:
  static constexpr std::int64_t NoOffset = -1;

  Error(ErrorCode code, const std::string& message, std::int64_t byteOffset = NoOffset)
      : std::runtime_error(byteOffset == NoOffset
                               ? message
                               : message + " (at byte " + std::to_string(byteOffset) + ")"),
        Code(code), ByteOffset(byteOffset)
  {}

  ErrorCode code() const { return this->Code; }
  /// Position in the file where the problem was found, or NoOffset.
  std::int64_t byteOffset() const { return this->ByteOffset; }

  /// The same error with `context` ("cannot read 'a.inr': ") in front of its message.
  Error inContext(const std::string& context) const
  {
    return Error(this->Code, this->ByteOffset, context + this->what());
  }

private:
  Error(ErrorCode code, std::int64_t byteOffset, const std::string& wholeMessage)
      : std::runtime_error(wholeMessage), Code(code), ByteOffset(byteOffset)
  {}

  ErrorCode Code;
  std::int64_t ByteOffset;
};

/// Throws InvalidArgument, with `message`, where `condition` does not hold.
inline void Require(bool condition, const char* message)
{
  if (!condition) {
    throw Error(ErrorCode::InvalidArgument, message);
  }
}

} // namespace inr
