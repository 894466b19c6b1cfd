// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/AlignedVector.h"
#include "Core/Inference/ModelView.h"
#include "Core/Training/Runtime/StateArray.h"
#include "Core/Training/Runtime/StopCheck.h"
#include "Core/Training/Samples/BatchSource.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace inr {

/// What takes the steps of a training: the CPU, or an accelerator.
class Descent
{
public:
  Descent() = default;
  virtual ~Descent() = default;
  Descent(const Descent&) = delete;
  Descent& operator=(const Descent&) = delete;

  /// One mini-batch; returns the mean squared error over it, before the update. Nothing when
  /// `check` stopped it: then no parameter has changed, and the next step draws the same batch. An
  /// update that has begun is always finished, but where memory runs out: Error(InvalidModel) says
  /// that there is nothing to go on from.
  virtual std::optional<double> step(BatchSource& batches,
                                     const StopCheck& check = StopCheck()) = 0;

  /// So many were taken. After a call of what is no const function they may have become fewer: what
  /// an accelerator that failed has taken with it.
  virtual std::uint64_t steps() const = 0;

  /// Spreads the learning rate over so many steps (default: no end in sight, a constant rate).
  virtual void plan(std::uint64_t steps) = 0;

  /// Where parameters, moments and counts of updates of the last step lie in the host's memory.
  /// With them, the number of steps and the plan, another one that was made alike goes on to the
  /// same parameters, bit for bit. When other bytes were put there: goOnAfter.
  virtual StateArrays state() = 0;
  virtual void goOnAfter(std::uint64_t steps) = 0;

  /// Takes random parameters from that seed in place of these, with no moments and no updates. The
  /// steps that were taken still count.
  virtual void startAnew(std::uint64_t seed) = 0;

  /// The same parameters, to look at or to take.
  virtual const ModelView& view() = 0;
  virtual AlignedVector<float>& parameters() = 0;

  virtual bool isAccelerated() const { return false; }
};

} // namespace inr
