// SPDX-License-Identifier: BSD-3-Clause
#include "Core/AtomicFile.h"

#include "Core/Error.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace inr {
namespace {

namespace fs = std::filesystem;

// What a path leads to, which need not be there yet. Of links in a circle, one of these.
std::string FollowLinks(const std::string& path)
{
  constexpr int mostLinks = 40; // as Linux follows
  fs::path target(path);
  std::error_code problem;
  for (int k = 0; k < mostLinks && fs::is_symlink(target, problem); ++k) {
    const fs::path next = fs::read_symlink(target, problem);
    if (problem) {
      break;
    }
    target = target.parent_path() / next; // which is `next` alone where that is absolute
  }
  return target.string();
}

constexpr int NotOrdinary = -1;

// Why `target` may not be replaced: an errno, or NotOrdinary; 0 when it may.
int ReasonToRefuse(const std::string& target)
{
  struct stat status
  {};
  if (stat(target.c_str(), &status) != 0) {
    return errno == ENOENT ? 0 : errno;
  }
  if (S_ISDIR(status.st_mode)) {
    return EISDIR;
  }
  if (!S_ISREG(status.st_mode)) {
    return NotOrdinary;
  }
  return access(target.c_str(), W_OK) == 0 ? 0 : errno;
}

std::string TemporaryStem(const std::string& target, pid_t process)
{
  return target + "." + std::to_string(process) + ".";
}

// Whose temporary file for `target` has this name; 0 = it is none.
pid_t WriterOf(const std::string& name, const std::string& target)
{
  long process = 0;
  int attempt = 0;
  const std::string tail =
      name.size() > target.size() + 1 && name.compare(0, target.size(), target) == 0
          ? name.substr(target.size())
          : "";
  const int read = std::sscanf(tail.c_str(), ".%ld.%d.tmp", &process, &attempt);
  const bool whole = read == 2 && process > 0 &&
                     tail == "." + std::to_string(process) + "." + std::to_string(attempt) + ".tmp";
  return whole ? static_cast<pid_t>(process) : 0;
}

bool IsGone(pid_t process) { return kill(process, 0) != 0 && errno == ESRCH; }

std::string FolderOf(const std::string& file)
{
  const fs::path folder = fs::path(file).parent_path();
  return folder.empty() ? "." : folder.string();
}

// Makes a new name in it durable. A file system that cannot do this has still renamed the file.
void FlushFolder(const std::string& folder)
{
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor >= 0) {
    (void)fsync(descriptor);
    close(descriptor);
  }
}

} // namespace

AtomicFile::AtomicFile(const std::string& path) : Path(path), Target(FollowLinks(path))
{
  if (const int reason = ReasonToRefuse(this->Target)) {
    this->fail(reason);
  }
  this->create();
}

AtomicFile::~AtomicFile()
{
  if (this->Descriptor >= 0) {
    close(this->Descriptor);
  }
  if (!this->Temporary.empty()) {
    (void)std::remove(this->Temporary.c_str());
  }
}

void AtomicFile::create()
{
  struct stat replaced
  {};
  const bool replaces = stat(this->Target.c_str(), &replaced) == 0;
  // A new file's permissions are left to the user's umask, which mkstemp would not do; another's
  // are kept, so that what was private stays so.
  const mode_t mode = replaces ? replaced.st_mode & 0777 : 0666;
  constexpr int Attempts = 1000;
  const std::string stem = TemporaryStem(this->Target, getpid());
  for (int attempt = 0; attempt < Attempts; ++attempt) {
    std::string name = stem + std::to_string(attempt) + ".tmp";
    this->Descriptor = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (this->Descriptor >= 0) {
      this->Temporary = std::move(name); // takes no memory, of which there may be none
      if (replaces) { // the umask may have taken some; where it cannot be undone, that is safe
        (void)fchmod(this->Descriptor, mode);
      }
      return;
    }
    if (errno != EEXIST) {
      break;
    }
  }
  this->fail(errno);
}

void AtomicFile::write(const void* data, std::size_t bytes)
{
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(this->Descriptor, next, bytes);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      this->fail(errno);
    }
    next += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::commit()
{
  const std::string folder = FolderOf(this->Target); // no memory is taken once the file is there
  const int descriptor = this->Descriptor;
  if (fsync(descriptor) != 0) {
    this->fail(errno);
  }
  this->Descriptor = -1;
  if (close(descriptor) != 0) {
    this->fail(errno);
  }
  if (std::rename(this->Temporary.c_str(), this->Target.c_str()) != 0) {
    this->fail(errno);
  }
  this->Temporary.clear();
  FlushFolder(folder);
}

void RemoveAbandonedFiles(const std::string& path)
{
  const fs::path target = FollowLinks(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code ignored;
  std::vector<fs::path> abandoned; // what is removed while a folder is read may end the reading
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const pid_t process = WriterOf(entry->path().filename().string(), target.filename().string());
    if (process != 0 && (process == getpid() || IsGone(process))) {
      abandoned.push_back(entry->path());
    }
  }
  for (const fs::path& file : abandoned) {
    fs::remove(file, ignored);
  }
}

void AtomicFile::fail(int reason) const
{
  const std::string text = reason == NotOrdinary ? "it is not an ordinary file"
                                                 : std::generic_category().message(reason);
  throw Error(ErrorCode::CannotWrite, "cannot write '" + this->Path + "': " + text);
}

} // namespace inr
