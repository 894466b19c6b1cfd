// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Image/Exr.h"
#include "Testing/Core/Image/RandomImage.h"

#include <Imath/ImathBox.h>
#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

namespace test::exr {

namespace fs = std::filesystem;

/// Lets no file grow beyond `bytes` while it lives: what a full disk does to a write.
class FileSizeLimit
{
public:
  explicit FileSizeLimit(rlim_t bytes) : Handler(std::signal(SIGXFSZ, SIG_IGN))
  {
    getrlimit(RLIMIT_FSIZE, &this->Before);
    rlimit limit = this->Before;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit()
  {
    setrlimit(RLIMIT_FSIZE, &this->Before);
    std::signal(SIGXFSZ, this->Handler);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
  void (*Handler)(int);
  rlimit Before{};
};

struct Exr : testing::Test
{
  // With the process' number: every case runs as a process of its own, several at a time.
  Exr() : Folder(fs::path(testing::TempDir()) / ("inr-exr-" + std::to_string(getpid())))
  {
    fs::create_directories(Folder);
  }
  ~Exr() override { fs::remove_all(Folder); }
  fs::path Folder;
};

TEST_F(Exr, KeepsEveryBit)
{
  inr::Image rgba = RandomImage(13, 7, 4, 1);
  rgba.pixel(2, 3)[0] = 1e-30f;
  rgba.pixel(2, 3)[1] = -1e30f;
  const inr::Image depth = RandomImage(13, 7, 1, 2);
  inr::WriteExr(Folder / "a.exr", rgba, depth);
  inr::Image readDepth;
  const inr::Image read = inr::ReadExr(Folder / "a.exr", &readDepth);
  EXPECT_EQ(read.pixels, rgba.pixels);
  EXPECT_EQ(readDepth.pixels, depth.pixels);
  EXPECT_EQ(read.width, 13);
}

TEST_F(Exr, KeepsSamplesAndLevels)
{
  const inr::Image rgba = RandomImage(13, 7, 4, 1);
  const inr::Image samples = RandomImage(13, 7, 2, 2);
  inr::WriteExr(Folder / "a.exr", rgba, {}, samples);
  inr::Image readDepth;
  inr::Image readSamples;
  EXPECT_EQ(inr::ReadExr(Folder / "a.exr", &readDepth, &readSamples).pixels, rgba.pixels);
  EXPECT_EQ(readSamples.pixels, samples.pixels);
  EXPECT_TRUE(readDepth.pixels.empty());
  EXPECT_THROW(inr::WriteExr(Folder / "a.exr", rgba, {}, RandomImage(13, 7, 1, 2)), inr::Error);
}

TEST_F(Exr, DepthIsOptional)
{
  inr::WriteExr(Folder / "b.exr", RandomImage(4, 4, 4, 3));
  inr::Image depth = RandomImage(1, 1, 1, 1);
  inr::ReadExr(Folder / "b.exr", &depth);
  EXPECT_TRUE(depth.pixels.empty());
}

TEST_F(Exr, LeavesNothingBehindWhenItFails)
{
  EXPECT_THROW(inr::WriteExr(Folder / "none" / "c.exr", RandomImage(4, 4, 4, 3)), inr::Error);
  EXPECT_THROW(inr::WriteExr(Folder / "c.exr", RandomImage(4, 4, 3, 3)), inr::Error);
  EXPECT_THROW(inr::WriteExr(Folder / "c.exr", RandomImage(4, 4, 4, 3), RandomImage(4, 5, 1, 3)),
               inr::Error);
  EXPECT_TRUE(fs::is_empty(Folder));
}

TEST_F(Exr, RefusesPicturesWithoutTheirPixels)
{
  inr::Image picture = RandomImage(8, 6, 4, 1);
  picture.width = 100000;
  EXPECT_THROW(inr::WriteExr(Folder / "wide.exr", picture), inr::Error);
  inr::Image depth = RandomImage(8, 6, 1, 1);
  inr::Image samples = RandomImage(8, 6, 2, 1);
  depth.pixels.pop_back();
  samples.pixels.pop_back();
  const inr::Image whole = RandomImage(8, 6, 4, 1);
  EXPECT_THROW(inr::WriteExr(Folder / "depth.exr", whole, depth), inr::Error);
  EXPECT_THROW(inr::WriteExr(Folder / "samples.exr", whole, {}, samples), inr::Error);
  picture.pixels.clear();
  EXPECT_THROW(inr::WriteExr(Folder / "empty.exr", picture), inr::Error);
  EXPECT_TRUE(fs::is_empty(Folder));
}

TEST_F(Exr, AFullDiskLeavesThePictureThatWasThere)
{
  const inr::Image before = RandomImage(8, 8, 4, 5);
  inr::WriteExr(Folder / "e.exr", before);
  const std::uintmax_t size = fs::file_size(Folder / "e.exr");
  for (std::uintmax_t bytes = 0; bytes < size; bytes += 50) {
    const FileSizeLimit limit(bytes);
    EXPECT_THROW(inr::WriteExr(Folder / "e.exr", RandomImage(8, 8, 4, 6)), inr::Error) << bytes;
  }
  EXPECT_EQ(inr::ReadExr(Folder / "e.exr").pixels, before.pixels);
  EXPECT_EQ(std::distance(fs::directory_iterator(Folder), fs::directory_iterator()), 1);
}

TEST_F(Exr, RefusesOneThatBeginsElsewhere)
{
  const std::string path = (Folder / "moved.exr").string();
  Imf::Header header(Imath::Box2i({0, 0}, {79, 79}), Imath::Box2i({5, -3}, {68, 60}));
  std::vector<float> values(64 * 64);
  Imf::FrameBuffer buffer;
  for (const char* channel : {"R", "G", "B", "A"}) {
    header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    buffer.insert(channel,
                  Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow(), sizeof(float)));
  }
  {
    Imf::OutputFile file(path.c_str(), header, 1);
    file.setFrameBuffer(buffer);
    file.writePixels(64);
  }
  try {
    inr::ReadExr(path);
    FAIL();
  } catch (const inr::Error& error) {
    EXPECT_NE(std::string(error.what()).find("(5, -3)"), std::string::npos) << error.what();
  }
}

TEST_F(Exr, RefusesWhatIsNotOne)
{
  std::ofstream(Folder / "d.exr") << "not an image";
  EXPECT_THROW(inr::ReadExr(Folder / "d.exr"), inr::Error);
  EXPECT_THROW(inr::ReadExr(Folder / "missing.exr"), inr::Error);
}

} // namespace test::exr
