// SPDX-License-Identifier: BSD-3-Clause
#include "Core/UsableMemory.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace inr {

namespace {

namespace fs = std::filesystem;
using Limit = std::optional<std::int64_t>;

/// "max" is no number, and no limit; nor is what is larger than any memory.
Limit ReadLimit(const fs::path& file)
{
  constexpr std::int64_t most = std::int64_t{1} << 60;
  std::int64_t bytes = 0;
  std::ifstream stream(file);
  return stream >> bytes && bytes > 0 && bytes < most ? Limit(bytes) : std::nullopt;
}

/// Of a group and all above it. In a container the group's path may be that of the host, which is
/// not there; the root is.
Limit LeastLimit(const fs::path& mounted, const std::string& group, const std::string& file)
{
  Limit least;
  fs::path path = fs::path(group).relative_path();
  for (bool more = true; more; path = path.parent_path()) {
    more = !path.empty();
    const Limit limit = ReadLimit(mounted / path / file);
    if (limit) {
      least = std::min(least.value_or(*limit), *limit);
    }
  }
  return least;
}

bool Lists(const std::string& controllers, const std::string& controller)
{
  return ("," + controllers + ",").find("," + controller + ",") != std::string::npos;
}

} // namespace

std::int64_t UsableMemory()
{
  std::int64_t memory =
      std::int64_t{sysconf(_SC_PHYS_PAGES)} * std::int64_t{sysconf(_SC_PAGE_SIZE)};
  memory = std::min(memory, ControlGroupMemory().value_or(memory));
  rlimit addresses{};
  const bool isLimited =
      getrlimit(RLIMIT_AS, &addresses) == 0 && addresses.rlim_cur < static_cast<rlim_t>(memory);
  return isLimited ? static_cast<std::int64_t>(addresses.rlim_cur) : memory;
}

std::optional<std::int64_t> ControlGroupMemory(const fs::path& root)
{
  const fs::path mounted = root / "sys/fs/cgroup";
  Limit least;
  std::ifstream groups(root / "proc/self/cgroup"); // number:controllers:path
  for (std::string line; std::getline(groups, line);) {
    std::istringstream fields(line);
    std::string number;
    std::string controllers;
    std::string path;
    std::getline(std::getline(std::getline(fields, number, ':'), controllers, ':'), path);
    Limit limit;
    if (controllers.empty()) {
      limit = LeastLimit(mounted, path, "memory.max");
    } else if (Lists(controllers, "memory")) {
      limit = LeastLimit(mounted / "memory", path, "memory.limit_in_bytes");
    }
    if (limit) {
      least = std::min(least.value_or(*limit), *limit);
    }
  }
  return least;
}

} // namespace inr
