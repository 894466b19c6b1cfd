// SPDX-License-Identifier: BSD-3-Clause
//
// Adam, LaneCount parameters at a time; see Inference/Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Lanes.h"
#include "Core/Training/Descent/TrainKernel.h"

namespace inr {
namespace INR_ISA {

using Counts = std::uint16_t __attribute__((vector_size(2 * LaneCount)));

/// AdamStep of LaneCount parameters.
struct AdamSteps
{
  Floats rate;
  Floats beta2;
};

/// Updates LaneCount parameters from k on; those whose lane of `which` is 0 stay as they are.
inline void AdamLanes(const AdamRun& run, std::int64_t k, const AdamSteps& steps, Ints which)
{
  const Floats old = Load(run.parameters + k);
  const Floats gradient = Load(run.gradients + k) + Spread(run.decay) * old;
  const Floats oldFirst = Load(run.firstMoments + k);
  const Floats oldSecond = Load(run.secondMoments + k);
  const Floats first = Spread(run.beta1) * oldFirst + Spread(1.0f - run.beta1) * gradient;
  const Floats second =
      steps.beta2 * oldSecond + (Spread(1.0f) - steps.beta2) * gradient * gradient;
  const Floats step = steps.rate * first / (SquareRoot(second) + Spread(run.epsilon));
  Store(run.firstMoments + k, which ? first : oldFirst);
  Store(run.secondMoments + k, which ? second : oldSecond);
  Store(run.parameters + k, which ? old - step : old);
}

/// Adds 1 to the counts whose lane of `which` is not 0, up to the last; returns those updates.
inline AdamSteps CountSteps(std::uint16_t* counts, Ints which, const AdamSchedule& schedule)
{
  Counts before;
  std::memcpy(&before, counts, sizeof(before));
  Ints count = __builtin_convertvector(before, Ints) - which; // a true comparison is -1
  const Ints last = (Ints)SpreadInt(schedule.last);
  count = count > last ? last : count;
  const Counts after = __builtin_convertvector(count, Counts);
  std::memcpy(counts, &after, sizeof(after));
  const Ints same = (Ints)SpreadInt((std::uint32_t)count[0]);
  if (IsZero((UInts)(count ^ same))) { // as where every mini-batch touches everything
    const AdamStep& step = schedule.steps[count[0]];
    return {Spread(step.rate), Spread(step.beta2)};
  }
  AdamSteps steps;
  for (int lane = 0; lane < LaneCount; ++lane) {
    const AdamStep& step = schedule.steps[count[lane]];
    steps.rate[lane] = step.rate;
    steps.beta2[lane] = step.beta2;
  }
  return steps;
}

inline void AdamSparseLanes(const AdamRun& run, std::int64_t k, float learningRate,
                            std::uint16_t* counts, const AdamSchedule& schedule)
{
  const Ints which = Load(run.gradients + k) != Floats{};
  AdamSteps steps = CountSteps(counts + k, which, schedule);
  steps.rate = Spread(learningRate) * steps.rate;
  AdamLanes(run, k, steps, which);
  Store(run.gradients + k, Floats{});
}

/// `count` (at most LaneCount) parameters that no whole vector holds.
inline AdamRun CopyOf(const AdamRun& run, std::int64_t k, std::int64_t count,
                      float (*lanes)[LaneCount])
{
  const float* const from[] = {run.parameters, run.gradients, run.firstMoments, run.secondMoments};
  for (int array = 0; array < 4; ++array) {
    std::memset(lanes[array], 0, sizeof(lanes[array]));
    std::memcpy(lanes[array], from[array] + k, static_cast<std::size_t>(count) * sizeof(float));
  }
  return {lanes[0], lanes[1], lanes[2], lanes[3], run.beta1, run.epsilon, run.decay};
}

inline void CopyBack(const AdamRun& copy, const AdamRun& run, std::int64_t k, std::int64_t count)
{
  const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(float);
  std::memcpy(run.parameters + k, copy.parameters, bytes);
  std::memcpy(run.gradients + k, copy.gradients, bytes);
  std::memcpy(run.firstMoments + k, copy.firstMoments, bytes);
  std::memcpy(run.secondMoments + k, copy.secondMoments, bytes);
}

inline void AdamAll(const AdamRun& run, std::int64_t count, AdamStep step)
{
  const AdamSteps steps{Spread(step.rate), Spread(step.beta2)};
  const Ints all = Floats{} == Floats{};
  std::int64_t k = 0;
  for (; k + LaneCount <= count; k += LaneCount) {
    AdamLanes(run, k, steps, all);
  }
  if (k < count) {
    float lanes[4][LaneCount];
    const AdamRun copy = CopyOf(run, k, count - k, lanes);
    AdamLanes(copy, 0, steps, all);
    CopyBack(copy, run, k, count - k);
  }
}

/// The last parameters, which fill no vector.
inline void AdamSparseRest(const AdamRun& run, std::int64_t k, std::int64_t count,
                           float learningRate, std::uint16_t* counts, const AdamSchedule& schedule)
{
  float lanes[4][LaneCount];
  std::uint16_t countLanes[LaneCount] = {};
  const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(std::uint16_t);
  std::memcpy(countLanes, counts + k, bytes);
  const AdamRun copy = CopyOf(run, k, count, lanes);
  AdamSparseLanes(copy, 0, learningRate, countLanes, schedule);
  CopyBack(copy, run, k, count);
  std::memcpy(counts + k, countLanes, bytes);
}

/// Parameters that are updated together: whole lines and whole vectors.
constexpr std::int64_t AdamTurn = LaneCount > GradientLine ? LaneCount : GradientLine;

/// Turns that are looked through for touched ones at a time.
constexpr int AdamTurns = 256;

/// Writes which of the turns from parameter `first` on have a touched line, and takes the marks
/// away. Returns how many.
inline int TakeTouched(std::uint8_t* touched, std::int64_t first, std::int64_t count,
                       std::int64_t (&turns)[AdamTurns])
{
  constexpr std::int64_t linesPerTurn = AdamTurn / GradientLine;
  const std::int64_t lines = (count + GradientLine - 1) / GradientLine;
  int found = 0;
  for (int turn = 0; turn < AdamTurns && first < count; ++turn, first += AdamTurn) {
    const std::int64_t begin = first / GradientLine;
    const std::int64_t end = begin + linesPerTurn < lines ? begin + linesPerTurn : lines;
    std::uint8_t any = 0;
    for (std::int64_t line = begin; line < end; ++line) {
      any |= touched[line];
      touched[line] = 0;
    }
    turns[found] = first; // without a branch, which could not be foretold
    found += any != 0 ? 1 : 0;
  }
  return found;
}

/// What a processor does not foresee where turns are left out.
inline void PrefetchTurn(const AdamRun& run, const std::uint16_t* counts, std::int64_t k)
{
  __builtin_prefetch(run.parameters + k, 1);
  __builtin_prefetch(run.gradients + k, 1);
  __builtin_prefetch(run.firstMoments + k, 1);
  __builtin_prefetch(run.secondMoments + k, 1);
  __builtin_prefetch(counts + k, 1);
}

/// Parameters [first, end), a turn or what is left of it.
inline void UpdateTurn(const AdamRun& run, std::int64_t first, std::int64_t end, float learningRate,
                       std::uint16_t* counts, const AdamSchedule& schedule)
{
  for (std::int64_t k = first; k < end; k += LaneCount) {
    if (k + LaneCount <= end) {
      AdamSparseLanes(run, k, learningRate, counts, schedule);
    } else {
      AdamSparseRest(run, k, end - k, learningRate, counts, schedule);
    }
  }
}

inline void AdamSparse(const AdamRun& run, std::int64_t count, std::uint8_t* touched,
                       float learningRate, std::uint16_t* counts, const AdamSchedule& schedule)
{
  constexpr int ahead = 8;
  std::int64_t turns[AdamTurns];
  for (std::int64_t first = 0; first < count; first += AdamTurns * AdamTurn) {
    const int found = TakeTouched(touched, first, count, turns);
    for (int turn = 0; turn < found; ++turn) {
      if (turn + ahead < found) {
        PrefetchTurn(run, counts, turns[turn + ahead]);
      }
      const std::int64_t end = turns[turn] + AdamTurn < count ? turns[turn] + AdamTurn : count;
      UpdateTurn(run, turns[turn], end, learningRate, counts, schedule);
    }
  }
}

} // namespace INR_ISA
} // namespace inr
