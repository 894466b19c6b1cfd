// SPDX-License-Identifier: BSD-3-Clause
//
// Limits that batch systems and containers set, in file systems as theirs.
#include "Core/UsableMemory.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sys/resource.h>

namespace test::usable_memory {

class ControlGroups : public testing::Test
{
protected:
  void write(const std::string& path, const std::string& text) const
  {
    const std::filesystem::path file = this->Root / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  std::optional<std::int64_t> memory() const { return inr::ControlGroupMemory(this->Root); }

  TemporaryFolder Folder;
  std::filesystem::path Root = Folder.file("root");
};

TEST_F(ControlGroups, LimitNothingWhereThereAreNone)
{
  EXPECT_EQ(this->memory(), std::nullopt);
  this->write("proc/self/cgroup", "0::/\n");
  EXPECT_EQ(this->memory(), std::nullopt); // the machine's own root has no such file
}

TEST_F(ControlGroups, LimitAsTheStrictestAbove)
{
  this->write("proc/self/cgroup", "0::/system.slice/job_7/step_0\n");
  this->write("sys/fs/cgroup/system.slice/memory.max", "max\n");
  EXPECT_EQ(this->memory(), std::nullopt);
  this->write("sys/fs/cgroup/system.slice/job_7/memory.max", "4294967296\n");
  this->write("sys/fs/cgroup/system.slice/job_8/memory.max", "1048576\n");
  this->write("sys/fs/cgroup/system.slice/job_7/step_0/memory.max", "max\n");
  EXPECT_EQ(this->memory(), std::int64_t{1} << 32);
  this->write("sys/fs/cgroup/system.slice/job_7/step_0/memory.max", "1073741824\n");
  EXPECT_EQ(this->memory(), 1 << 30);
}

TEST_F(ControlGroups, OfVersionOne)
{
  this->write("proc/self/cgroup", "5:cpuset:/a\n4:cpu,memory:/slurm/uid_0/job_3\n0::/\n");
  this->write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(this->memory(), std::nullopt);
  this->write("sys/fs/cgroup/cpuset/a/memory.limit_in_bytes", "17\n");
  this->write("sys/fs/cgroup/memory/slurm/uid_0/job_3/memory.limit_in_bytes", "536870912\n");
  EXPECT_EQ(this->memory(), 1 << 29);
}

// Which sees its own group as the root, but may be told of the host's path.
TEST_F(ControlGroups, OfAContainer)
{
  this->write("proc/self/cgroup", "0::/docker/0123\n");
  this->write("sys/fs/cgroup/memory.max", "2147483648\n");
  EXPECT_EQ(this->memory(), std::int64_t{1} << 31);
}

TEST(UsableMemory, IsNoMoreThanTheGroupAllows)
{
  EXPECT_GT(inr::UsableMemory(), 1 << 26);
  EXPECT_LE(inr::UsableMemory(),
            inr::ControlGroupMemory().value_or(std::numeric_limits<std::int64_t>::max()));
}

TEST(UsableMemory, IsNoMoreThanTheAddressesAllow)
{
#ifdef INR_SANITIZED
  GTEST_SKIP() << "the sanitizer asks for addresses at any time";
#endif
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit few = before;
  few.rlim_cur = 64 << 20; // fewer than are in use, so nothing may ask for any meanwhile
  const std::int64_t all = inr::UsableMemory();
  ASSERT_EQ(setrlimit(RLIMIT_AS, &few), 0);
  const std::int64_t some = inr::UsableMemory();
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_GT(all, 64 << 20);
  EXPECT_EQ(some, 64 << 20);
}

} // namespace test::usable_memory
