// SPDX-License-Identifier: BSD-3-Clause
//
// Every allocation of loading a model fails once: an error, nothing lost, and the next try
// succeeds.
#include "Core/Error.h"
#include "Core/Model/ModelBytes.h"
#include "Testing/Core/Memory/FailingMemory.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <functional>

namespace {

using For = FailingMemory::For;

struct Loading : testing::Test
{
  /// True while there was an allocation to fail.
  static bool failsWell(std::int64_t nth, For how, const std::function<void()>& load)
  {
    const std::int64_t before = BlocksInUse();
    bool failed = false;
    bool thrown = false;
    try {
      const FailingMemory memory(nth, how);
      try {
        load();
      } catch (...) {
        failed = memory.hasFailed();
        throw;
      }
      failed = memory.hasFailed();
    } catch (const inr::Error& error) {
      thrown = true;
      EXPECT_EQ(error.code(), inr::ErrorCode::TooLarge) << nth << ": " << error.what();
      EXPECT_NE(std::string(error.what()).find("memory"), std::string::npos) << error.what();
    } catch (const std::bad_alloc&) { // not even for the message
      thrown = true;
    }
    EXPECT_EQ(failed, thrown) << "allocation " << nth << " was missed by nobody";
    EXPECT_EQ(BlocksInUse(), before) << "allocation " << nth << " cost memory for good";
    return failed;
  }

  static void expectSurvives(const std::function<void()>& load)
  {
    load(); // what is only made once
    for (const For how : {For::Once, For::Good}) {
      std::int64_t nth = 1;
      while (failsWell(nth, how, load) && !HasFailure()) {
        ++nth;
      }
      EXPECT_GT(nth, 10) << "there was hardly anything to fail";
    }
    EXPECT_NO_THROW(load());
  }

  TemporaryFolder Folder;
};

TEST_F(Loading, AFileOfEitherKind)
{
  const std::string path = Folder.file("model.inr");
  for (const auto& model : {FullModel(), CompactModel()}) {
    inr::WriteModel(*model, path);
    this->expectSurvives([&] { inr::ReadModel(path); });
    EXPECT_EQ(inr::ReadModel(path)->parameters, model->parameters);
  }
}

TEST_F(Loading, TheHeaderOnly)
{
  const std::string path = Folder.file("model.inr");
  inr::WriteModel(*FullModel(), path);
  this->expectSurvives([&] { inr::ReadModelHeader(path); });
}

TEST_F(Loading, AModelThatIsSent)
{
  const std::string bytes = inr::ModelToBytes(*CompactModel());
  this->expectSurvives([&] { inr::ModelFromBytes(bytes); });
}

TEST_F(Loading, LooksAtTheKindOfAFile)
{
  const std::string path = Folder.file("model.inr");
  inr::WriteModel(*FullModel(), path);
  std::int64_t nth = 1;
  for (bool failed = true; failed && nth < 100; ++nth) {
    const FailingMemory memory(nth, For::Once);
    try {
      inr::IsModelFile(path);
    } catch (const std::bad_alloc&) {
    }
    failed = memory.hasFailed();
  }
  EXPECT_LT(nth, 100);
  EXPECT_TRUE(inr::IsModelFile(path));
}

} // namespace
