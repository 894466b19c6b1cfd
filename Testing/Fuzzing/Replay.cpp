// SPDX-License-Identifier: BSD-3-Clause
//
// Calls a fuzz target with every file of a folder, without a fuzzer: what once was found stays
// mended. Ends with 0 when all of them came back; a target ends the process where one does not.
//
//     replay_NAME FOLDER-OR-FILE...
#include "Testing/Fuzzing/Target.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> FilesOf(const fs::path& path)
{
  std::vector<fs::path> files;
  if (!fs::is_directory(path)) {
    return {path};
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void Replay(const fs::path& path)
{
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::printf("%s\n", path.filename().c_str()); // the last one said is the one that failed
  std::fflush(stdout);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

} // namespace

int main(int argc, char** argv)
{
  int count = 0;
  for (int k = 1; k < argc; ++k) {
    for (const fs::path& path : FilesOf(argv[k])) {
      Replay(path);
      ++count;
    }
  }
  std::printf("%d inputs\n", count);
  return count > 0 ? 0 : 1;
}
