// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/RawOutput.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Testing/Turbulence/ChannelGrid.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <sstream>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace inr {
namespace {

std::atomic<bool> Stopped{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

using Sink = std::function<void(const void* data, std::size_t bytes)>;

template <class Bits> void SwapBytes(void* values, std::int64_t count)
{
  auto* const bits = static_cast<Bits*>(values);
  for (std::int64_t k = 0; k < count; ++k) {
    if constexpr (sizeof(Bits) == 8) {
      bits[k] = __builtin_bswap64(bits[k]);
    } else {
      bits[k] = __builtin_bswap32(bits[k]);
    }
  }
}

// Block by block: rows of one plane, as many as fit.
template <class T, class Bits>
void Stream(const TurbulentChannel& field, const RawVolumeFile& file, const Sink& sink)
{
  const glm::i64vec3& dims = file.dims;
  const ChannelGrid grid(field, dims);
  const Arena arena;
  const std::int64_t rows =
      std::clamp(file.blockBytes / (dims.x * file.scalar()), std::int64_t{1}, dims.y * dims.z);
  const std::int64_t planes = std::max(std::int64_t{1}, rows / dims.y);
  const glm::i64vec3 block(dims.x, std::min(rows, dims.y), planes);
  std::vector<T> values(static_cast<std::size_t>(block.x * block.y * block.z));
  for (std::int64_t z = 0; z < dims.z; z += block.z) {
    for (std::int64_t y = 0; y < dims.y; y += block.y) {
      if (Stopped) {
        throw Error(ErrorCode::Cancelled, "stopped; nothing was written");
      }
      const glm::i64vec3 begin(0, y, z);
      const glm::i64vec3 size(dims.x, std::min(block.y, dims.y - y), std::min(block.z, dims.z - z));
      const std::int64_t count = size.x * size.y * size.z;
      grid.box(arena, begin, size, values.data());
      if (file.bigEndian != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__)) {
        SwapBytes<Bits>(values.data(), count);
      }
      sink(values.data(), static_cast<std::size_t>(count) * sizeof(T));
    }
  }
}

void Stream(const TurbulentChannel& field, const RawVolumeFile& file, const Sink& sink)
{
  if (file.doubles) {
    Stream<double, std::uint64_t>(field, file, sink);
  } else {
    Stream<float, std::uint32_t>(field, file, sink);
  }
}

// Points lie where the voxels' centres are in the channel, in half-heights.
std::string Header(const RawVolumeFile& file, const std::string& rawName)
{
  const glm::dvec3 spacing = TurbulentChannel::Size / glm::dvec3(file.dims);
  std::ostringstream text;
  text.precision(17);
  text << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = "
       << (file.bigEndian ? "True" : "False")
       << "\nCompressedData = False\nDimSize = " << file.dims.x << " " << file.dims.y << " "
       << file.dims.z << "\nElementSpacing = " << spacing.x << " " << spacing.y << " " << spacing.z
       << "\nOffset = " << 0.5 * spacing.x << " " << 0.5 * spacing.y << " " << 0.5 * spacing.z
       << "\nElementType = " << (file.doubles ? "MET_DOUBLE" : "MET_FLOAT")
       << "\nElementDataFile = " << rawName << "\n";
  return text.str();
}

void RequireRoom(const std::string& path, std::int64_t bytes)
{
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error) {
    throw Error(ErrorCode::CannotWrite, "cannot write '" + path + "': " + error.message());
  }
  if (static_cast<std::uintmax_t>(bytes) > space.available) {
    throw Error(ErrorCode::CannotWrite, "'" + path + "' would take " + std::to_string(bytes) +
                                            " bytes, and its disk has room for " +
                                            std::to_string(space.available));
  }
}

// Ends the writing instead of the process, so that no temporary file stays.
void StopOnSignals()
{
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { Stopped = true; });
  }
}

void WriteOut(const void* data, std::size_t bytes)
{
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(STDOUT_FILENO, next, bytes);
    if (written < 0 && errno != EINTR) {
      throw Error(ErrorCode::CannotWrite,
                  "cannot write to standard output: " + std::generic_category().message(errno));
    }
    next += std::max<ssize_t>(written, 0);
    bytes -= static_cast<std::size_t>(std::max<ssize_t>(written, 0));
  }
}

} // namespace

void WriteRawVolume(const TurbulentChannel& field, const RawVolumeFile& file,
                    const std::string& path)
{
  const std::string rawName = std::filesystem::path(path + ".raw").filename().string();
  const std::string header = Header(file, rawName);
  RequireRoom(path + ".raw", file.bytes() + static_cast<std::int64_t>(header.size()));
  StopOnSignals();
  AtomicFile headerFile(path + ".mhd");
  headerFile.write(header.data(), header.size());
  AtomicFile rawFile(path + ".raw");
  Stream(field, file, [&](const void* data, std::size_t bytes) { rawFile.write(data, bytes); });
  rawFile.commit();
  headerFile.commit();
}

void StreamRawVolume(const TurbulentChannel& field, const RawVolumeFile& file)
{
  Stream(field, file, WriteOut);
}

} // namespace inr
