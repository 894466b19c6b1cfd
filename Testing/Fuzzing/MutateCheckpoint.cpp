// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/ModelBlobs.h"
#include "Testing/Fuzzing/CheckpointArrays.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned int seed);

namespace {

constexpr std::size_t Start = 16;       // magic, version, length of the header
constexpr std::size_t ChecksumSize = 4; // the header's, behind it
constexpr std::size_t FrontSize = 16;   // name and length of an array
constexpr std::size_t VersionAt = 8;    // 2: the same arrays are there twice

void PutChecksum(std::uint8_t* begin, std::size_t bytes)
{
  const std::uint32_t checksum = inr::ContinueChecksum(0, begin, bytes);
  std::memcpy(begin + bytes, &checksum, sizeof(checksum));
}

/// An array's is of its bytes, then of what is in front of them.
void PutArrayChecksum(std::uint8_t* front, std::size_t bytes)
{
  std::uint32_t checksum = inr::ContinueChecksum(0, front + FrontSize, bytes);
  checksum = inr::ContinueChecksum(checksum, front, FrontSize);
  std::memcpy(front + FrontSize + bytes, &checksum, sizeof(checksum));
}

/// The header's text is what is in front of arrays of the known size; its checksum made right, and
/// those of the arrays.
void Repair(std::uint8_t* data, std::size_t size)
{
  if (size <= VersionAt) {
    return;
  }
  CheckpointArrays arrays;
  inr::StateArrays known = arrays.list();
  if (data[VersionAt] == 2) {
    const inr::StateArrays survey = known;
    known.insert(known.end(), survey.begin(), survey.end());
  }
  std::size_t behind = 0;
  for (const inr::StateArray& array : known) {
    behind += FrontSize + static_cast<std::size_t>(array.bytes) + ChecksumSize;
  }
  if (size < Start + ChecksumSize + behind) {
    return;
  }
  const std::size_t header = size - behind - ChecksumSize;
  const auto length = static_cast<std::uint32_t>(header - Start);
  std::memcpy(data + Start - sizeof(length), &length, sizeof(length));
  PutChecksum(data, header);
  std::uint8_t* at = data + header + ChecksumSize;
  for (const inr::StateArray& array : known) {
    const auto bytes = static_cast<std::size_t>(array.bytes);
    PutArrayChecksum(at, bytes);
    at += FrontSize + bytes + ChecksumSize;
  }
}

} // namespace

/// The header's text, more often than all of it, with the checksums put right.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned int seed)
{
  if (seed % 8 < 2 || size <= Start) {
    size = LLVMFuzzerMutate(data, size, most);
  } else {
    std::uint32_t length = 0;
    std::memcpy(&length, data + Start - sizeof(length), sizeof(length));
    length = static_cast<std::uint32_t>(std::min<std::size_t>(length, size - Start));
    // Room is made behind the text, and closed again.
    const std::size_t tail = size - Start - length;
    const std::size_t room = std::min<std::size_t>(most - tail - Start, length + 64);
    const std::vector<std::uint8_t> kept(data + Start + length, data + size);
    const std::size_t now = LLVMFuzzerMutate(data + Start, length, room);
    std::copy(kept.begin(), kept.end(), data + Start + now);
    size = Start + now + tail;
  }
  if (seed % 16 != 0) {
    Repair(data, size);
  }
  return size;
}
