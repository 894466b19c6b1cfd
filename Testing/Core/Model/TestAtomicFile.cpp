// SPDX-License-Identifier: BSD-3-Clause
#include "Core/AtomicFile.h"
#include "Core/Error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace fs = std::filesystem;

namespace test::atomic_file {

class AtomicFileTest : public testing::Test
{
protected:
  void SetUp() override
  {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    this->Folder = fs::path(testing::TempDir()) / (std::string("inr_atomic_") + test->name());
    fs::remove_all(this->Folder);
    fs::create_directory(this->Folder);
  }
  void TearDown() override { fs::remove_all(this->Folder); }

  std::string path(const char* name) const { return (this->Folder / name).string(); }

  std::ptrdiff_t entries() const
  {
    return std::distance(fs::directory_iterator(this->Folder), fs::directory_iterator());
  }

  static std::string Read(const std::string& path)
  {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  static void Write(const std::string& path, const std::string& text)
  {
    inr::AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
  }

  static void ExpectRefused(const std::string& path, const std::string& reason)
  {
    try {
      inr::AtomicFile file(path);
      ADD_FAILURE() << path << " was accepted";
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::CannotWrite);
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  fs::path Folder;
};

TEST_F(AtomicFileTest, CommitReplacesTheTarget)
{
  Write(this->path("a"), "old");
  Write(this->path("a"), "new");
  EXPECT_EQ(Read(this->path("a")), "new");
  EXPECT_EQ(this->entries(), 1);
}

TEST_F(AtomicFileTest, KeepsThePermissionsOfWhatItReplaces)
{
  const std::string path = this->path("a");
  Write(path, "old");
  for (const int mode : {0600, 0666}) { // narrower and wider than what the usual umask gives
    fs::permissions(path, fs::perms(mode));
    Write(path, "new");
    EXPECT_EQ(fs::status(path).permissions(), fs::perms(mode));
  }
}

TEST_F(AtomicFileTest, WithoutCommitNothingChanges)
{
  Write(this->path("a"), "old");
  {
    inr::AtomicFile file(this->path("a"));
    file.write("half", 4);
    EXPECT_EQ(this->entries(), 2);
    EXPECT_EQ(Read(this->path("a")), "old");
  }
  EXPECT_EQ(Read(this->path("a")), "old");
  EXPECT_EQ(this->entries(), 1);
}

TEST_F(AtomicFileTest, AnotherWriterMayFillTheTemporaryFile)
{
  inr::AtomicFile file(this->path("a"));
  std::ofstream(file.temporaryPath()) << "by a library";
  file.commit();
  EXPECT_EQ(Read(this->path("a")), "by a library");
}

TEST_F(AtomicFileTest, TwoWritersDoNotMeet)
{
  inr::AtomicFile first(this->path("a"));
  inr::AtomicFile second(this->path("a"));
  EXPECT_NE(first.temporaryPath(), second.temporaryPath());
  first.write("1", 1);
  second.write("2", 1);
  first.commit();
  second.commit();
  EXPECT_EQ(Read(this->path("a")), "2");
  EXPECT_EQ(this->entries(), 1);
}

TEST_F(AtomicFileTest, LinksAreFollowed)
{
  Write(this->path("real"), "old");
  fs::create_symlink("chain", this->path("link"));
  fs::create_symlink(this->path("real"), this->path("chain"));
  Write(this->path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(this->path("link")));
  EXPECT_EQ(Read(this->path("real")), "new");
}

TEST_F(AtomicFileTest, LinksToWhatIsNotThereYetAreFollowed)
{
  fs::create_directory(this->Folder / "store");
  fs::create_symlink("store/chain", this->path("link"));
  fs::create_symlink("real", this->path("store/chain"));
  Write(this->path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(this->path("link")));
  EXPECT_TRUE(fs::is_symlink(this->path("store/chain")));
  EXPECT_EQ(Read(this->path("store/real")), "new");
  fs::create_symlink("circle", this->path("circle"));
  ExpectRefused(this->path("circle"), "Too many levels of symbolic links");
}

TEST_F(AtomicFileTest, RefusalsNamePathAndReason)
{
  ExpectRefused(this->path("no/such/folder"), "No such file or directory");
  ExpectRefused(this->Folder.string(), "Is a directory");
  ExpectRefused("/dev/null", "not an ordinary file");
  Write(this->path("file"), "x");
  ExpectRefused(this->path("file/below"), "Not a directory");
  EXPECT_EQ(this->entries(), 1);
}

} // namespace test::atomic_file
