// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Image/Exr.h"
#include "Testing/Core/Image/RandomImage.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;

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

TEST_F(Exr, RefusesWhatIsNotOne)
{
  std::ofstream(Folder / "d.exr") << "not an image";
  EXPECT_THROW(inr::ReadExr(Folder / "d.exr"), inr::Error);
  EXPECT_THROW(inr::ReadExr(Folder / "missing.exr"), inr::Error);
}

} // namespace
