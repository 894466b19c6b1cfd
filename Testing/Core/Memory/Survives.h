// SPDX-License-Identifier: BSD-3-Clause
//
// Every allocation of something fails once, and once together with all that follow.
#pragma once

#include "Core/Error.h"
#include "Testing/Core/Memory/FailingMemory.h"

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <string>

/// With the nth one failing, `act` throws, says why if it can, and loses nothing. True while there
/// was one to fail.
inline bool FailsWell(std::int64_t nth, FailingMemory::For how, const std::function<void()>& act)
{
  const std::int64_t before = BlocksInUse();
  bool failed = false;
  bool thrown = false;
  try {
    const FailingMemory memory(nth, how);
    try {
      act();
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

/// `prepare` is called before each try, and `check` after each failure.
inline void ExpectSurvives(
    const std::function<void()>& act, const std::function<void()>& prepare = [] {},
    const std::function<void()>& check = [] {})
{
  act(); // what is only made once
  for (const FailingMemory::For how : {FailingMemory::For::Once, FailingMemory::For::Good}) {
    std::int64_t nth = 1;
    for (prepare(); FailsWell(nth, how, act) && !testing::Test::HasFailure(); ++nth) {
      check();
      prepare();
    }
    EXPECT_GT(nth, 10) << "there was hardly anything to fail";
  }
  EXPECT_NO_THROW(act());
}
