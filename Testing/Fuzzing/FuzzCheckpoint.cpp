// SPDX-License-Identifier: BSD-3-Clause
//
// Bytes -> a training's checkpoint: its state and its arrays, or inr::Error and unchanged arrays.
#include "Core/Error.h"
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Testing/Fuzzing/CheckpointArrays.h"
#include "Testing/Fuzzing/Target.h"

#include <cmath>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const MemoryFile file(data, size);
  CheckpointArrays arrays;
  CheckpointArrays survey;
  bool loaded = false;
  bool surveyed = false;
  try {
    const inr::CheckpointFile checkpoint(file.path());
    INR_REQUIRE(std::isfinite(checkpoint.state().seconds) && checkpoint.state().seconds >= 0);
    INR_REQUIRE(std::isfinite(checkpoint.state().psnr));
    if (checkpoint.hasSurvey()) {
      checkpoint.loadSurvey(survey.list());
      surveyed = true;
    }
    checkpoint.load(arrays.list());
    loaded = true;
  } catch (const inr::Error& error) {
    INR_REQUIRE(error.what()[0] != '\0');
  }
  INR_REQUIRE(loaded || arrays == CheckpointArrays());
  INR_REQUIRE(surveyed || survey == CheckpointArrays());
  return 0;
}
