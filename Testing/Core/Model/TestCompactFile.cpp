// SPDX-License-Identifier: BSD-3-Clause
//
// Files with quantised parameters: what is read is what was written, and bad frames are refused.
#include "Core/Error.h"
#include "Core/Model/Compression.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <zlib.h>

namespace {

struct CompactFile : testing::Test
{
  CompactFile() : Bytes(this->write(*CompactModel())) {}

  std::string path() const { return Folder.file("model.inr"); }

  std::string write(const inr::Model& model)
  {
    inr::WriteModel(model, this->path());
    return ReadBytes(this->path());
  }

  inr::ModelPointer roundTrip(const inr::Model& model)
  {
    this->write(model);
    return inr::ReadModel(this->path());
  }

  void expectUnwritable(const inr::Model& model, const std::string& words)
  {
    try {
      inr::WriteModel(model, this->path());
      ADD_FAILURE() << words << ": written";
    } catch (const inr::Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  void expectRefused(const std::string& bytes, const std::string& words)
  {
    WriteBytes(this->path(), bytes);
    try {
      inr::ReadModel(this->path());
      ADD_FAILURE() << words << ": accepted";
    } catch (const inr::Error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(this->path()), std::string::npos) << message;
      EXPECT_NE(message.find(words), std::string::npos) << message;
    }
  }

  TemporaryFolder Folder;
  std::string Bytes;
};

TEST_F(CompactFile, GivesBackWhatWasWritten)
{
  const auto written = CompactModel();
  const inr::ModelPointer read = this->roundTrip(*written);
  EXPECT_EQ(read->parameters, written->parameters);
  EXPECT_EQ(read->steps, written->steps);
  EXPECT_EQ(read->storedAs, inr::ParameterType::Quantised);
  EXPECT_EQ(read->macroCells.dims, written->macroCells.dims);
  EXPECT_EQ(read->macroCells.apron, written->macroCells.apron);
  EXPECT_EQ(read->volume.direction, written->volume.direction);
  EXPECT_EQ(this->write(*read), this->Bytes);
}

TEST_F(CompactFile, RoundsToTheNearestMultiple)
{
  auto model = CompactModel();
  model->steps[0] = 0.25f;
  model->parameters[0] = 0.30f;
  model->parameters[1] = -0.38f;
  const inr::ModelPointer read = this->roundTrip(*model);
  EXPECT_EQ(read->parameters[0], 0.25f);
  EXPECT_EQ(read->parameters[1], -0.5f);
}

TEST_F(CompactFile, TakesParametersOfAnyMagnitude)
{
  for (const float magnitude : {0.0f, 1e-44f, 1e-30f, 1.0f, 65504.0f, 1e30f, 3.4e38f}) {
    auto model = CompactModel();
    const std::vector<inr::ParameterGroup> groups = inr::ParameterGroups(model->description);
    for (std::size_t k = 0; k < groups.size(); ++k) {
      float* first = model->parameters.data() + groups[k].offset;
      model->steps[k] = inr::FinestStep(magnitude);
      for (std::uint64_t i = 0; i < groups[k].count; ++i) {
        first[i] = magnitude * (i % 2 == 0 ? 1.0f : -inr::RandomUnit(k, i));
      }
      inr::RoundToStep(first, groups[k].count, model->steps[k]);
    }
    const inr::ModelPointer read = this->roundTrip(*model);
    EXPECT_EQ(read->parameters, model->parameters) << magnitude;
    EXPECT_NEAR(read->parameters[0], magnitude, 4e-5 * magnitude + 1e-37);
  }
}

TEST_F(CompactFile, KeepsEveryMultipleOfSixteenBits)
{
  auto model = CompactModel();
  const inr::ParameterGroup last = inr::ParameterGroups(model->description).back();
  const float step = model->steps.back();
  for (std::uint64_t k = 0; k < last.count; ++k) {
    const auto multiple = static_cast<std::int16_t>(32767 - 31 * static_cast<int>(k % 2115));
    model->parameters[last.offset + k] = inr::ValueOfMultiple(multiple, step);
  }
  EXPECT_EQ(this->roundTrip(*model)->parameters, model->parameters);
}

TEST_F(CompactFile, IsMuchSmallerThanInHalfPrecision)
{
  auto half = CompactModel();
  half->storedAs = inr::ParameterType::Half;
  EXPECT_LT(2 * this->Bytes.size(), this->write(*half).size() + 2500); // besides the header
}

TEST_F(CompactFile, SizeIsExactWithParametersAndABoundWithout)
{
  auto model = CompactModel();
  const auto size = static_cast<std::int64_t>(this->Bytes.size());
  EXPECT_EQ(inr::ModelFileSize(*model), size);
  EXPECT_EQ(inr::WriteModel(*model, this->path()), size);
  model->parameters.clear();
  EXPECT_GE(inr::ModelFileSize(*model), size);
  model->steps.clear();
  EXPECT_GE(inr::ModelFileSize(*model), size);
}

TEST_F(CompactFile, SaysItsVersionAndOthersKeepTheirs)
{
  const auto version = [](const std::string& bytes) {
    return static_cast<int>(bytes[bytes.find("format_version") + 15]);
  };
  EXPECT_EQ(version(this->Bytes), 2);
  const std::string plain = this->write(*FullModel());
  EXPECT_EQ(version(plain), 1);
  EXPECT_EQ(plain.find("\x04steps"), std::string::npos);
}

/// A model with so many macro-cells, whose ranges the caller fills.
std::shared_ptr<inr::Model> WithCells(std::int64_t count)
{
  auto model = CompactModel();
  model->macroCells = inr::MakeMacroCells({count * 16, 1, 1}, 16);
  return model;
}

TEST_F(CompactFile, RangesContainWhatTheyWere)
{
  constexpr std::int64_t count = 20000;
  auto model = WithCells(count);
  std::vector<inr::ValueRange>& ranges = model->macroCells.ranges;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    float low = inr::RandomUnit(1, k);
    if (k % 2 == 0) { // on a bound that can be stored, or beside it
      low = std::nextafter(static_cast<float>(k / 2 % 256) / 255.0f,
                           static_cast<float>(k % 3) - 0.5f);
      low = std::fmin(std::fmax(low, 0.0f), 1.0f);
    }
    ranges[k] = {low, low + (1 - low) * inr::RandomUnit(2, k) * static_cast<float>(k % 5 != 0)};
  }
  const inr::ModelPointer read = this->roundTrip(*model);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const inr::ValueRange& stored = read->macroCells.ranges[k];
    ASSERT_LE(stored.low, ranges[k].low) << k;
    ASSERT_GE(stored.high, ranges[k].high) << k;
    ASSERT_LT(ranges[k].low - stored.low, 1.00001f / 255) << k;
    ASSERT_LT(stored.high - ranges[k].high, 1.00001f / 255) << k;
  }
}

TEST_F(CompactFile, RangesKeepEmptinessAndWhatIsExact)
{
  auto model = WithCells(4);
  model->macroCells.ranges = {{}, {0, 0}, {1, 1}, {-0.5f, 1.5f}};
  const inr::ModelPointer read = this->roundTrip(*model);
  const std::vector<inr::ValueRange>& ranges = read->macroCells.ranges;
  EXPECT_TRUE(ranges[0].empty());
  EXPECT_EQ(ranges[1].high, 0.0f);
  EXPECT_EQ(ranges[2].low, 1.0f);
  EXPECT_EQ(ranges[3].low, 0.0f); // the output never leaves [0, 1]
  EXPECT_EQ(ranges[3].high, 1.0f);
}

TEST_F(CompactFile, WrongCountsOfParametersAreNoted)
{
  auto model = CompactModel();
  model->parameters.pop_back();
  this->expectUnwritable(*model, "parameters");
  EXPECT_THROW(inr::ModelFileSize(*model), inr::Error);
}

TEST_F(CompactFile, NeedsNoMacroCells)
{
  auto model = CompactModel();
  model->macroCells = {};
  EXPECT_TRUE(this->roundTrip(*model)->macroCells.empty());
}

TEST_F(CompactFile, WritesNothingThatCannotBeRead)
{
  const auto good = CompactModel();
  const auto with = [&](const auto& change) {
    auto model = std::make_shared<inr::Model>(*good);
    change(*model);
    return *model;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float step : {0.0f, -0.5f, nan, HUGE_VALF, 1e-40f, 3e38f}) {
    this->expectUnwritable(with([&](auto& model) { model.steps[1] = step; }), "step");
  }
  this->expectUnwritable(with([](auto& model) { model.steps.pop_back(); }), "step");
  this->expectUnwritable(with([](auto& model) { model.steps.clear(); }), "step");
  this->expectUnwritable(with([](auto& model) { model.parameters[3] = 1e6f; }), "parameter 3");
  this->expectUnwritable(with([&](auto& model) { model.parameters[3] = nan; }), "parameter 3");
  this->expectUnwritable(with([&](auto& model) { model.macroCells.ranges[2].low = nan; }),
                         "range 2");
  EXPECT_EQ(ReadBytes(this->path()), this->Bytes);
}

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
  EXPECT_EQ(read->parameters, std::vector<float>(read->parameters.size(), 0.0f));
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
  const std::string frame = inr::Compress(bytes, boundaries);
  EXPECT_LE(static_cast<std::int64_t>(frame.size()), inr::CompressedBound(3000, 3000));
  const auto plain = inr::Decompress(frame, 3000, "bytes");
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(plain.get()), 3000), bytes);
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

} // namespace
