// SPDX-License-Identifier: BSD-3-Clause
//
// The floating-point environment belongs to the caller.
#include "Core/Inference/Evaluator.h"
#include "Core/Inference/OverflowWatch.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <cfloat>
#ifdef __x86_64__
#include <pmmintrin.h>
#endif

namespace test::float_modes {

/// One whose values all overflow on their way.
inr::ModelPointer HugeModel()
{
  auto model = RandomModel(SmallDescription());
  for (float& parameter : model->parameters) {
    parameter *= 1e30f;
  }
  return model;
}

std::vector<float> ValuesOf(const inr::ModelPointer& model, const std::string& kernel)
{
  const std::vector<glm::vec3> positions = RandomPositions(50);
  const std::vector<float> axes[3] = {{0.1f, 0.2f}, {0.3f}, {0.4f, 0.9f}};
  const auto evaluator = inr::MakeEvaluator(model, kernel);
  std::vector<float> values(54);
  evaluator->evaluate(positions.data(), 50, values.data());
  evaluator->evaluateGrid(axes, values.data() + 50);
  return values;
}

/// Puts the thread's floating-point environment back.
class KeptEnvironment
{
public:
  KeptEnvironment() { std::fegetenv(&this->Before); }
  ~KeptEnvironment() { std::fesetenv(&this->Before); }
  KeptEnvironment(const KeptEnvironment&) = delete;
  KeptEnvironment& operator=(const KeptEnvironment&) = delete;

private:
  std::fenv_t Before;
};

TEST(FloatModes, FlagsAreLeftAsTheyWere)
{
  const KeptEnvironment kept;
  for (const inr::ModelPointer& model :
       {HugeModel(), inr::ModelPointer(RandomModel(SmallDescription()))}) {
    for (const std::string& kernel : UsableKernels()) {
      std::feclearexcept(FE_ALL_EXCEPT);
      ValuesOf(model, kernel);
      EXPECT_EQ(std::fetestexcept(FE_OVERFLOW | FE_INVALID | FE_DIVBYZERO), 0) << kernel;
      std::feraiseexcept(FE_OVERFLOW);
      ValuesOf(model, kernel);
      EXPECT_EQ(std::fetestexcept(FE_OVERFLOW | FE_INVALID | FE_DIVBYZERO), FE_OVERFLOW) << kernel;
    }
  }
}

/// An overflow of the caller's does not count as one of ours.
TEST(FloatModes, FlagsOfTheCallerChangeNoValue)
{
  const KeptEnvironment kept;
  const auto model = RandomModel(SmallDescription());
  for (const std::string& kernel : UsableKernels()) {
    std::feclearexcept(FE_ALL_EXCEPT);
    const std::vector<float> expected = ValuesOf(model, kernel);
    std::feraiseexcept(FE_ALL_EXCEPT);
    EXPECT_EQ(ValuesOf(model, kernel), expected) << kernel;
  }
}

#ifdef __x86_64__
TEST(FloatModes, FlushingToZeroStaysAsTheCallerSetIt)
{
  const KeptEnvironment kept;
  constexpr unsigned modes = ~static_cast<unsigned>(_MM_EXCEPT_MASK);
  for (const unsigned flush : {0u, static_cast<unsigned>(_MM_FLUSH_ZERO_ON),
                               static_cast<unsigned>(_MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON)}) {
    for (const std::string& kernel : UsableKernels()) {
      _mm_setcsr((_mm_getcsr() & ~0x8040u) | flush);
      const unsigned before = _mm_getcsr();
      ValuesOf(HugeModel(), kernel);
      EXPECT_EQ(_mm_getcsr() & modes, before & modes) << kernel;
    }
  }
}

/// A host program may flush denormal numbers to zero: ordinary models do not notice.
TEST(FloatModes, FlushingToZeroChangesNoOrdinaryValue)
{
  const KeptEnvironment kept;
  for (const std::string& kernel : UsableKernels()) {
    _mm_setcsr(_mm_getcsr() & ~0x8040u);
    const std::vector<float> expected = ValuesOf(RandomModel(SmallDescription()), kernel);
    _mm_setcsr(_mm_getcsr() | 0x8040u);
    EXPECT_EQ(ValuesOf(RandomModel(SmallDescription()), kernel), expected) << kernel;
  }
}
#endif

/// Where one of many values overflows, the others stay what they were.
TEST(FloatModes, TheWatchSeesWhatOverflowsAndNothingElse)
{
  const KeptEnvironment kept;
  volatile float large = FLT_MAX;
  volatile float zero = 0.0f;
  std::feraiseexcept(FE_OVERFLOW);
  inr::OverflowWatch watch;
  EXPECT_FALSE(watch.overflowed());
  volatile float result = zero / zero; // a NaN, but no overflow
  EXPECT_FALSE(watch.overflowed());
  result = large * large;
  EXPECT_TRUE(watch.overflowed());
  watch.restart();
  EXPECT_FALSE(watch.overflowed());
  static_cast<void>(result);
}

} // namespace test::float_modes
