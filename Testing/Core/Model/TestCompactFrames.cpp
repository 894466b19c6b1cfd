// SPDX-License-Identifier: BSD-3-Clause
//
// Compact files with frames, steps and versions that are not as they should be.
#include "Core/Model/Compression.h"
#include "Core/Model/ModelBytes.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Core/Model/CompactFile.h"

#include <cmath>
#include <cstring>
#include <zlib.h>

namespace test::compact_frames {

void AddToLength(std::string& bytes, std::size_t at, std::int32_t amount)
{
  std::int32_t length = 0;
  std::memcpy(&length, bytes.data() + at, 4);
  length += amount;
  std::memcpy(bytes.data() + at, &length, 4);
}

/// `bytes` with another blob under `key` of `section`, every length and the checksum in order.
std::string WithBlob(std::string bytes, const std::string& section, const std::string& key,
                     const std::string& blob)
{
  const std::size_t document = bytes.find('\x03' + section + '\0') + section.size() + 2;
  const std::size_t length = bytes.find('\x05' + key + '\0') + key.size() + 2;
  std::int32_t before = 0;
  std::memcpy(&before, bytes.data() + length, 4);
  bytes.replace(length + 5, static_cast<std::size_t>(before), blob);
  for (const std::size_t at : {std::size_t{0}, document, length}) {
    AddToLength(bytes, at, static_cast<std::int32_t>(blob.size()) - before);
  }
  const auto blobAt = [&](const std::string& name) {
    const std::size_t at = bytes.find('\x05' + name + '\0') + name.size() + 2;
    std::int32_t size = 0;
    std::memcpy(&size, bytes.data() + at, 4);
    return bytes.substr(at + 5, static_cast<std::size_t>(size));
  };
  std::uint32_t checksum = 0;
  for (const std::string& part : {blobAt("params_binary"), blobAt("data")}) {
    checksum = static_cast<std::uint32_t>(
        crc32_z(checksum, reinterpret_cast<const Bytef*>(part.data()), part.size()));
  }
  char digits[9];
  std::snprintf(digits, sizeof(digits), "%08x", checksum);
  return bytes.replace(bytes.find("crc32:") + 6, 8, digits);
}

struct Frames : CompactFile
{
  std::string withParameters(const std::string& frame) const
  {
    return WithBlob(this->Bytes, "parameters", "params_binary", frame);
  }
  std::string withRanges(const std::string& frame) const
  {
    return WithBlob(this->Bytes, "macrocell", "data", frame);
  }
  std::size_t plainBytes() const { return 2 * CompactModel()->parameters.size(); }
};

TEST_F(Frames, OfTheRightSizeAreRead)
{
  WriteBytes(this->path(),
             this->withParameters(inr::Compress(std::string(this->plainBytes(), '\0'))));
  const inr::ModelPointer read = inr::ReadModel(this->path());
  EXPECT_EQ(read->parameters, inr::AlignedVector<float>(read->parameters.size(), 0.0f));
  WriteBytes(this->path(),
             this->withParameters(inr::Compress(std::string(this->plainBytes(), '\xff'))));
  EXPECT_EQ(inr::ReadModel(this->path())->parameters[0], -32768 * read->steps[0]);
  const std::size_t cells = CompactModel()->macroCells.ranges.size();
  WriteBytes(this->path(), this->withRanges(inr::Compress(std::string(2 * cells, '\x33'))));
  EXPECT_EQ(inr::ReadModel(this->path())->macroCells.ranges[0].high, 0.2f);
}

TEST_F(Frames, MayEndBlocksAnywhere)
{
  std::string bytes;
  std::vector<std::size_t> boundaries;
  for (std::size_t k = 0; k < 3000; ++k) {
    boundaries.push_back(k);
    bytes += static_cast<char>(inr::RandomBits(1, k));
  }
  for (const inr::Packing packing : {inr::Packing::Small, inr::Packing::Fast}) {
    const std::string frame = inr::Compress(bytes, boundaries, packing);
    EXPECT_LE(static_cast<std::int64_t>(frame.size()), inr::CompressedBound(3000, 3000));
    const auto plain = inr::Decompress(frame, 3000, "bytes");
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(plain.get()), 3000), bytes);
  }
}

TEST_F(Frames, ThatSomebodyWaitsForAreNotPackedAsSmallAsCanBe)
{
  std::string bytes; // of two values, whose order says nothing
  for (std::size_t k = 0; k < 100000; ++k) {
    bytes += static_cast<char>(inr::RandomBits(1, k) & inr::RandomBits(2, k) & 3);
  }
  const std::size_t small = inr::Compress(bytes, {}, inr::Packing::Small).size();
  EXPECT_LT(small, inr::Compress(bytes, {}, inr::Packing::Fast).size());
  const inr::ModelPointer model = CompactModel();
  EXPECT_NE(inr::ModelToBytes(*model).size(), static_cast<std::size_t>(inr::ModelFileSize(*model)));
}

TEST_F(Frames, OfOtherSizesAreRefused)
{
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, this->plainBytes() - 1,
                                 this->plainBytes() + 1, std::size_t{50'000'000}}) {
    const std::string frame = inr::Compress(std::string(size, '\0'));
    this->expectRefused(this->withParameters(frame), "packed parameters");
    this->expectRefused(this->withRanges(frame), "packed macro-cell ranges");
  }
}

TEST_F(Frames, ThatAreNoSingleWholeFrameAreRefused)
{
  const std::string good = inr::Compress(std::string(this->plainBytes(), 'x'));
  const std::string half = inr::Compress(std::string(this->plainBytes() / 2, 'x'));
  const std::string skippable("\x50\x2a\x4d\x18\x04\0\0\0abcd", 12);
  for (const std::string& bytes :
       {std::string(), std::string("x"), good + "x", half + half, skippable, skippable + good,
        good + skippable, good.substr(0, good.size() - 1), good.substr(1), std::string(500, 'z')}) {
    this->expectRefused(this->withParameters(bytes), "packed parameters");
  }
  for (std::size_t at = 0; at < good.size(); ++at) { // damage that the checksum knows nothing of
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x41);
    WriteBytes(this->path(), this->withParameters(bytes));
    try {
      EXPECT_EQ(inr::ReadModel(this->path())->parameters.size(), this->plainBytes() / 2);
    } catch (const inr::Error&) {
    }
  }
}

TEST_F(Frames, DamagedOnesHaveAnotherChecksum)
{
  std::string bytes = this->Bytes;
  char& byte = bytes[bytes.find("crc32:") + 6];
  byte = byte == '0' ? '1' : '0';
  this->expectRefused(bytes, "checksum");
}

TEST_F(Frames, CannotClaimMoreThanTheyMay)
{
  constexpr std::int64_t mebibyte = 1 << 20;
  EXPECT_TRUE(inr::MayExpand(100, 256 * mebibyte));
  EXPECT_FALSE(inr::MayExpand(100, 256 * mebibyte + 1));
  EXPECT_TRUE(inr::MayExpand(5 * mebibyte, 320 * mebibyte));
  EXPECT_FALSE(inr::MayExpand(5 * mebibyte, 320 * mebibyte + 1));
  std::string bytes = this->Bytes;
  const std::int32_t huge = 0x7fffffff;
  std::memcpy(bytes.data() + bytes.find("n_params") + 9, &huge, 4);
  this->expectRefused(bytes, "does not fit");
}

TEST_F(Frames, ManyMoreCellsThanBytesAreRefused)
{
  for (const glm::ivec3 many : {glm::ivec3(4096, 4096, 16), {4096, 4096, 4096}, {-1, 1, 1}}) {
    std::string bytes = this->Bytes;
    const std::size_t dims = bytes.find("dims", bytes.find(std::string("macrocell\0", 10)));
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t at = bytes.find(std::string("\x10") + "xyz"[axis] + '\0', dims);
      std::memcpy(bytes.data() + at + 3, &many[axis], 4);
    }
    this->expectRefused(bytes, "dims");
  }
}

struct Steps : CompactFile
{
  std::string with(double step) const
  {
    std::string bytes = this->Bytes;
    const std::size_t second = bytes.find(std::string("\x01"
                                                      "1\0",
                                                      3),
                                          bytes.find("\x04steps"));
    std::memcpy(bytes.data() + second + 3, &step, 8);
    return bytes;
  }
};

TEST_F(Steps, ThatMakeNoSenseAreRefused)
{
  WriteBytes(this->path(), this->with(0.5));
  EXPECT_EQ(inr::ReadModel(this->path())->steps[1], 0.5f);
  for (const double step : {0.0, -0.5, 1e-40, 2e34, 1e300}) {
    this->expectRefused(this->with(step), "steps");
  }
  for (const double step : {std::nan(""), HUGE_VAL}) {
    this->expectRefused(this->with(step), "");
  }
}

TEST_F(Steps, ThatAreMissingAreRefused)
{
  std::string bytes = this->Bytes;
  bytes.replace(bytes.find("\x04steps") + 1, 5, "other");
  this->expectRefused(bytes, "parameters.steps");
}

TEST_F(CompactFile, VersionAndTypeBelongTogether)
{
  std::string bytes = this->Bytes;
  bytes[bytes.find("format_version") + 15] = 1;
  this->expectRefused(bytes, "belong together");
  bytes = this->write(*FullModel());
  bytes[bytes.find("format_version") + 15] = 2;
  this->expectRefused(bytes, "belong together");
  bytes = this->Bytes;
  bytes.replace(bytes.find(std::string("inr\0", 4)), 3, "irn");
  this->expectRefused(bytes, "'inr' is missing");
}

} // namespace test::compact_frames
