// SPDX-License-Identifier: BSD-3-Clause
//
// Every allocation of loading a model fails once: an error, nothing lost, and the next try
// succeeds.
#include "Core/Model/ModelBytes.h"
#include "Testing/Core/Memory/Survives.h"
#include "Testing/Core/Model/TemporaryFolder.h"

namespace test::loading_without_memory {

struct Loading : testing::Test
{
  TemporaryFolder Folder;
};

TEST_F(Loading, AFileOfEitherKind)
{
  const std::string path = Folder.file("model.inr");
  for (const auto& model : {FullModel(), CompactModel()}) {
    inr::WriteModel(*model, path);
    ExpectSurvives([&] { inr::ReadModel(path); });
    EXPECT_EQ(inr::ReadModel(path)->parameters, model->parameters);
  }
}

TEST_F(Loading, TheHeaderOnly)
{
  const std::string path = Folder.file("model.inr");
  inr::WriteModel(*FullModel(), path);
  ExpectSurvives([&] { inr::ReadModelHeader(path); });
}

TEST_F(Loading, AModelThatIsSent)
{
  const std::string bytes = inr::ModelToBytes(*CompactModel());
  ExpectSurvives([&] { inr::ModelFromBytes(bytes); });
}

TEST_F(Loading, LooksAtTheKindOfAFile)
{
  const std::string path = Folder.file("model.inr");
  inr::WriteModel(*FullModel(), path);
  std::int64_t nth = 1;
  for (bool failed = true; failed && nth < 100; ++nth) {
    const FailingMemory memory(nth, FailingMemory::For::Once);
    try {
      inr::IsModelFile(path);
    } catch (const std::bad_alloc&) {
    }
    failed = memory.hasFailed();
  }
  EXPECT_LT(nth, 100);
  EXPECT_TRUE(inr::IsModelFile(path));
}

} // namespace test::loading_without_memory
