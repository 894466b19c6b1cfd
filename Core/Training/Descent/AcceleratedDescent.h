// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Timer.h"
#include "Core/Training/Descent/Descent.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Descent/TrainingAccelerator.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace inr {

/// Steps by an accelerator, and by the CPU from when that fails.
///
/// The CPU's GradientDescent holds a copy of some earlier step, from where it goes on then: of the
/// last one that somebody wanted to see, and no older than CopyInterval steps or, where that is
/// longer, than fifty times what a copy takes, which is 14 bytes per parameter. Then the model is
/// the one of a CPU that had taken all steps, but from storage once blocks are read again, which
/// steps that are taken twice see as they are by then: as good, but another one. The accelerator's
/// first step is compared with the CPU's: one that gives other values has failed.
///
/// While the accelerator computes a step, the samples of the next are drawn, if it draws none.
class AcceleratedDescent : public Descent
{
public:
  static constexpr std::uint64_t CopyInterval = 200;

  /// `host`, which must outlive this, has taken no step yet. `failed` is told why the accelerator
  /// has, once. `now` is a clock, in seconds.
  AcceleratedDescent(GradientDescent& host, std::unique_ptr<AcceleratedTraining> device,
                     const Arena& arena, std::function<void(const std::string&)> failed,
                     std::function<double()> now = SteadySeconds);

  std::optional<double> step(BatchSource& batches, const StopCheck& check = StopCheck()) override;
  std::uint64_t steps() const override { return this->Device ? this->Steps : this->Host.steps(); }
  void plan(std::uint64_t steps) override;
  StateArrays state() override;
  void goOnAfter(std::uint64_t steps) override;
  void startAnew(std::uint64_t seed) override;
  const ModelView& view() override;
  AlignedVector<float>& parameters() override;
  bool isAccelerated() const override { return this->Device != nullptr; }

  bool drawsSamples() const { return this->DrawsSamples; }

  /// Whether any step that counts was the accelerator's, and any other, after it had failed.
  bool hasUsedDevice() const { return this->UsedDevice; }

private:
  /// A mini-batch that was drawn before its step.
  struct DrawnBatch
  {
    std::uint64_t step;
    std::uint64_t planned;
  };

  std::optional<double> stepOnDevice(BatchSource& batches, const StopCheck& check);
  std::optional<double> compareStep(BatchSource& batches, const StopCheck& check);
  bool draw(BatchSource& batches, std::uint64_t step, const StopCheck& check);
  void begin();
  void settle();
  void fetch();
  void keepCopy();
  bool agrees() const;
  void giveUp(const std::string& reason);

  GradientDescent& Host;
  std::unique_ptr<AcceleratedTraining> Device; ///< null = it has failed
  const Arena& Threads;
  std::function<void(const std::string&)> Failed;
  std::function<double()> Now;
  bool DrawsSamples;
  bool UsedDevice = false;
  bool IsThere = false;    ///< the device has the state
  bool IsChecked = false;  ///< and was compared with the CPU
  std::uint64_t Steps = 0; ///< the device's
  std::uint64_t PlannedSteps = std::numeric_limits<std::uint64_t>::max();
  std::optional<DrawnBatch> Drawn;
  int Buffer = 0; ///< where it is
  /// What comes from the device, which may break off; then the copy of before stays.
  std::vector<std::vector<char>> Arriving;
  double CopySeconds = 0; ///< that the last one took
  double CopiedAt = 0;    ///< by the clock
};

} // namespace inr
