// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Inference/InstructionSet.h"

#include <gtest/gtest.h>

namespace test::instruction_set {

using inr::InstructionSet;

bool OnlyBaseline(InstructionSet set) { return set == InstructionSet::Baseline; }
bool NoAvx512(InstructionSet set) { return set != InstructionSet::Avx512; }

std::string Refusal(const std::string& name, bool (*usable)(InstructionSet))
{
  try {
    inr::ChooseInstructionSet(name, usable);
  } catch (const inr::Error& error) {
    EXPECT_EQ(error.code(), inr::ErrorCode::Unsupported);
    return error.what();
  }
  return "";
}

TEST(InstructionSet, IsTheBestThatRuns)
{
  EXPECT_EQ(inr::ChooseInstructionSet("", OnlyBaseline), InstructionSet::Baseline);
  EXPECT_EQ(inr::ChooseInstructionSet("", NoAvx512), InstructionSet::Avx2);
  EXPECT_EQ(inr::ChooseInstructionSet("baseline", NoAvx512), InstructionSet::Baseline);
}

TEST(InstructionSet, RefusesByNameWhatTheProcessorLacks)
{
  for (const char* name : {"avx2", "avx512"}) {
    const std::string message = Refusal(name, OnlyBaseline);
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find("processor"), std::string::npos) << message;
  }
}

TEST(InstructionSet, NamesTheKnownOnesWhereTheNameIsNone)
{
  EXPECT_NE(
      Refusal("abacus", inr::IsUsable).find("baseline, avx2 and avx512, to infer with also amx"),
      std::string::npos);
}

TEST(InstructionSet, ALargerOneIsUsableOnlyWithTheSmallerOnes)
{
  EXPECT_TRUE(inr::IsUsable(InstructionSet::Baseline));
  EXPECT_TRUE(!inr::IsUsable(InstructionSet::Avx512) || inr::IsUsable(InstructionSet::Avx2));
}

} // namespace test::instruction_set
