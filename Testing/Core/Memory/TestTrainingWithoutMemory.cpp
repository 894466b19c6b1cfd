// SPDX-License-Identifier: BSD-3-Clause
//
// Memory that runs out somewhere in a training.
#include "Core/Error.h"
#include "Testing/Core/Memory/FailingMemory.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>

namespace test::training_without_memory {

class TrainingWithoutMemory : public testing::Test
{
protected:
  inr::TrainingOptions options() const
  {
    inr::TrainingOptions options = Steps(6);
    options.description = SmallDescription();
    options.storedAs = inr::ParameterType::Half;
    options.threads = 1; // so that the n-th allocation is the same every time
    options.checkpoint.path = this->Path;
    return options;
  }
  inr::ModelPointer train(const inr::TrainingObserver& observer = {}) const
  {
    return inr::TrainModel(this->Data.data(), {}, this->options(), observer);
  }

  /// With the n-th allocation behind the first step failing; whether there was one.
  bool fails(std::int64_t nth)
  {
    std::optional<FailingMemory> memory;
    try {
      this->train([&](const inr::TrainingProgress& now) {
        if (now.steps > 0 && !memory) {
          memory.emplace(nth, FailingMemory::For::Once);
        }
        return true;
      });
    } catch (const inr::Error& error) {
      EXPECT_NE(std::string(error.what()).find("memory"), std::string::npos) << error.what();
    }
    return memory->hasFailed();
  }

  TemporaryFolder Folder;
  std::string Path = Folder.file("a.inr.checkpoint");
  Field<float> Data = WaveField();
};

/// What is kept is of whole steps, or there is nothing to go on from.
TEST_F(TrainingWithoutMemory, GoesOnToTheSameModel)
{
  const inr::AlignedVector<float> whole = this->train()->parameters;
#ifdef INR_SANITIZED // which has each training take ten times as long
  constexpr std::int64_t stride = 29;
#else
  constexpr std::int64_t stride = 7; // through all kinds of them
#endif
  int kept = 0;
  for (std::int64_t nth = 1; this->fails(nth) && !HasFailure(); nth += stride) {
    kept += std::filesystem::exists(this->Path) ? 1 : 0;
    EXPECT_EQ(this->train()->parameters, whole) << "allocation " << nth;
    std::filesystem::remove(this->Path);
  }
  EXPECT_GT(kept, 0);
}

} // namespace test::training_without_memory
