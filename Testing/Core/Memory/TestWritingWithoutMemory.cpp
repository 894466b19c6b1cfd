// SPDX-License-Identifier: BSD-3-Clause
//
// Every allocation of writing a model fails once: an error, what was there before is untouched,
// nothing is left behind, and the next try succeeds.
#include "Core/Model/ModelBytes.h"
#include "Testing/Core/Memory/Survives.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <iterator>

namespace test::writing_without_memory {

struct Writing : testing::Test
{
  TemporaryFolder Folder;
};

TEST_F(Writing, AFileOfEitherKind)
{
  const std::string path = Folder.file("model.inr");
  for (const auto& model : {FullModel(), CompactModel()}) {
    const std::string before(1000, 'x');
    ExpectSurvives([&] { inr::WriteModel(*model, path); }, [&] { WriteBytes(path, before); },
                   [&] {
                     EXPECT_EQ(ReadBytes(path), before);
                     EXPECT_EQ(std::distance(std::filesystem::directory_iterator(Folder.Path), {}),
                               1);
                   });
    EXPECT_EQ(inr::ReadModel(path)->parameters, model->parameters);
  }
}

TEST_F(Writing, AModelThatIsSent)
{
  for (const auto& model : {FullModel(), CompactModel()}) {
    std::string bytes;
    ExpectSurvives([&] { bytes = inr::ModelToBytes(*model); });
    EXPECT_EQ(inr::ModelFromBytes(bytes)->parameters, model->parameters);
  }
}

TEST_F(Writing, OnlyAsksWhetherAndHowLarge)
{
  const auto model = CompactModel();
  ExpectSurvives([&] { inr::RequireStorable(*model); });
  ExpectSurvives([&] { inr::ModelFileSize(*model); });
}

} // namespace test::writing_without_memory
