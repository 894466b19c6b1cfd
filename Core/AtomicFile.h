// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace inr {

/// A file that appears under its name whole or not at all: it is written under a temporary name in
/// the same folder, and `commit` renames it. It has the permissions of the file that it replaces,
/// if any. Without a commit the destructor removes it, and whatever had the name before stays
/// untouched.
class AtomicFile
{
public:
  /// Creates the temporary file. A link is followed; anything there that is not an ordinary,
  /// writable file is refused. Throws Error(CannotWrite) with path and reason, as all do here.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// For libraries that open files themselves; they must have closed it before `commit`.
  const std::string& temporaryPath() const { return this->Temporary; }

  /// Appends.
  void write(const void* data, std::size_t bytes);

  /// Flushes to the disk, then renames.
  void commit();

private:
  [[noreturn]] void fail(int reason) const;
  void create();

  std::string Path;   ///< as the caller named it, for messages
  std::string Target; ///< links followed
  std::string Temporary;
  int Descriptor = -1;
};

/// Removes the temporary files for `path` of processes that were killed before their destructors
/// ran: those of processes which are no longer there, or which had this one's number. So this
/// process must not be writing the file just now.
void RemoveAbandonedFiles(const std::string& path);

} // namespace inr
