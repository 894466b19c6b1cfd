// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Descent/AcceleratedDescent.h"

#include "Core/Error.h"
#include "Core/NumberText.h"
#include "Core/Training/Runtime/LearningRate.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

namespace inr {

namespace {

constexpr double PauseForCopy = 50; // seconds between copies for each that one takes

/// Or neither a number.
bool IsNear(double a, double b, double tolerance)
{
  return (!std::isfinite(a) && !std::isfinite(b)) || std::abs(a - b) <= tolerance;
}

} // namespace

AcceleratedDescent::AcceleratedDescent(GradientDescent& host,
                                       std::unique_ptr<AcceleratedTraining> device,
                                       const Arena& arena,
                                       std::function<void(const std::string&)> failed,
                                       std::function<double()> now)
    : Host(host), Device(std::move(device)), Threads(arena), Failed(std::move(failed)),
      Now(std::move(now)), DrawsSamples(this->Device->drawsSamples())
{}

void AcceleratedDescent::plan(std::uint64_t steps)
{
  this->PlannedSteps = steps;
  this->Host.plan(steps);
}

StateArrays AcceleratedDescent::state()
{
  this->settle();
  return this->Host.state();
}

void AcceleratedDescent::goOnAfter(std::uint64_t steps)
{
  this->Host.goOnAfter(steps);
  this->Steps = steps;
  this->IsThere = false;
}

void AcceleratedDescent::startAnew(std::uint64_t seed)
{
  this->settle();
  this->Host.startAnew(seed);
  this->IsThere = false;
}

const ModelView& AcceleratedDescent::view()
{
  this->settle();
  return this->Host.view();
}

AlignedVector<float>& AcceleratedDescent::parameters()
{
  this->settle();
  return this->Host.parameters();
}

std::optional<double> AcceleratedDescent::step(BatchSource& batches, const StopCheck& check)
{
  if (this->Device) {
    try {
      return this->stepOnDevice(batches, check);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Device) {
        throw;
      }
      this->giveUp(error.what());
    }
  }
  return this->Host.step(batches, check);
}

std::optional<double> AcceleratedDescent::stepOnDevice(BatchSource& batches, const StopCheck& check)
{
  if (!this->draw(batches, this->Steps, check)) {
    return std::nullopt;
  }
  if (!this->IsThere) {
    this->Device->put(this->Host.state());
    this->IsThere = true;
  }
  if (!this->IsChecked) {
    return this->compareStep(batches, check);
  }
  this->begin();
  std::exception_ptr stopped; // which is no reason to forget the step
  try {
    if (this->Steps + 1 < this->PlannedSteps) {
      this->draw(batches, this->Steps + 1, check);
    }
  } catch (...) {
    stopped = std::current_exception();
  }
  const double loss = this->Device->finish();
  ++this->Steps;
  if (stopped) {
    std::rethrow_exception(stopped);
  }
  const bool isDue = this->Steps - this->Host.steps() >= CopyInterval &&
                     this->Now() - this->CopiedAt >= PauseForCopy * this->CopySeconds;
  if (isDue) {
    this->settle();
  }
  return loss;
}

/// The first step, by both. What the CPU has stopped, has not begun on the device.
std::optional<double> AcceleratedDescent::compareStep(BatchSource& batches, const StopCheck& check)
{
  const std::optional<double> expected = this->Host.step(batches, check);
  if (!expected) {
    return std::nullopt;
  }
  try {
    this->begin();
    const double loss = this->Device->finish();
    this->fetch();
    // Sums in another order are off by 1e-6 or so.
    if (!IsNear(loss, *expected, 1e-3 * *expected) || !this->agrees()) {
      throw Error(ErrorCode::Device, "its first step is another one than the CPU's, with an error "
                                     "of " +
                                         NumberText(loss) + " in place of " +
                                         NumberText(*expected));
    }
    this->IsChecked = true;
    ++this->Steps;
    this->keepCopy();
    return loss;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Device) {
      throw;
    }
    this->giveUp(error.what());
    return expected; // the CPU has taken this step
  }
}

/// Whether the parameters that have arrived are the host's but for some hundredth, whose gradients
/// may be nothing but rounding: Adam goes as far with these. A tenth of a usual step is near
/// enough: of Adam's the learning rate, of a layer's its share of what is nearly orthogonal.
bool AcceleratedDescent::agrees() const
{
  const StateArrays expected = this->Host.state();
  const std::size_t count = this->Host.parameters().size();
  const auto valueOf = [](const void* from, std::size_t k) {
    float value = 0;
    std::memcpy(&value, static_cast<const char*>(from) + k * sizeof(float), sizeof(float));
    return value;
  };
  const auto differs = [&](std::size_t begin, std::size_t end, float tolerance) {
    std::size_t moved = 0;
    std::size_t others = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const float value = valueOf(this->Arriving[0].data(), k);
      others += IsNear(value, valueOf(expected[0].data, k), tolerance) ? 0 : 1;
      moved += valueOf(expected[1].data, k) != 0.0f ? 1 : 0;
    }
    return others > moved / 100 + 8;
  };
  const float near = 0.1f * LearningRate().at(this->Steps, this->PlannedSteps);
  for (const LayerShape& layer : this->Host.orthogonalisedLayers()) {
    const auto size =
        static_cast<std::size_t>(layer.rows) * static_cast<std::size_t>(layer.columns);
    const float share = 1.0f / std::sqrt(static_cast<float>(std::max(layer.rows, layer.columns)));
    if (differs(layer.offset, layer.offset + size,
                near * OrthogonalRate(this->Steps + 1) * share)) {
      return false;
    }
  }
  const std::size_t weights = this->Host.weightCount();
  return !differs(this->Host.firstOtherWeight(), weights, near) && !differs(weights, count, near);
}

/// Samples for a step that the device draws none for; false when `check` stopped it.
bool AcceleratedDescent::draw(BatchSource& batches, std::uint64_t step, const StopCheck& check)
{
  if (this->Drawn && this->Drawn->step == step && this->Drawn->planned == this->PlannedSteps) {
    return check.goesOn();
  }
  batches.prepare({step, this->PlannedSteps, this->Host.stream()}, check);
  if (!check.goesOn()) {
    return false;
  }
  if (!this->DrawsSamples) {
    this->Buffer = 1 - this->Buffer; // the other one may be on its way
    const AcceleratedTraining::Samples samples = this->Device->samples(this->Buffer);
    DrawBatch(batches, this->Host.stream(), step, this->Threads, samples.positions,
              samples.targets);
  }
  this->Drawn = {step, this->PlannedSteps};
  return true;
}

void AcceleratedDescent::begin()
{
  const float rate = LearningRate().at(this->Steps, this->PlannedSteps);
  this->Device->begin({this->Steps, rate, this->Buffer});
}

/// Brings the last step to the host, or else makes it the one that the host has.
void AcceleratedDescent::settle()
{
  if (!this->Device || !this->IsThere || this->Steps == this->Host.steps()) {
    return;
  }
  try {
    this->fetch();
    this->keepCopy();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Device) {
      throw;
    }
    this->giveUp(error.what());
  } catch (const std::bad_alloc&) { // for what it has
    this->giveUp("there is not enough memory for its parameters");
  }
}

void AcceleratedDescent::fetch()
{
  const double begun = this->Now();
  StateArrays arrays = this->Host.state();
  this->Arriving.resize(arrays.size());
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    this->Arriving[k].resize(static_cast<std::size_t>(arrays[k].bytes));
    arrays[k].data = this->Arriving[k].data();
  }
  this->Device->get(arrays);
  this->CopySeconds = this->Now() - begun;
}

void AcceleratedDescent::keepCopy()
{
  const StateArrays arrays = this->Host.state();
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    std::memcpy(arrays[k].data, this->Arriving[k].data(), this->Arriving[k].size());
  }
  this->Host.goOnAfter(this->Steps);
  this->UsedDevice = true;
  this->CopiedAt = this->Now();
}

void AcceleratedDescent::giveUp(const std::string& reason)
{
  this->Device.reset();
  this->Arriving.clear();
  const std::uint64_t kept = this->Host.steps();
  const std::uint64_t lost = this->Steps > kept ? this->Steps - kept : 0;
  this->Failed(reason + ". The CPU goes on with the training after " + std::to_string(kept) +
               " steps" + (lost > 0 ? ", and takes " + std::to_string(lost) + " steps again" : ""));
}

} // namespace inr
