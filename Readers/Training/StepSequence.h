// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// The time steps that a writer writes in one go, one after the other and again from the start.
class StepSequence
{
public:
  StepSequence() = default;

  /// Of steps at these `times` every `stride`th from number `first` to `last`, or to the end where
  /// that is before `first`. Throws inr::Error(InvalidArgument) when that is none.
  StepSequence(std::vector<double> times, int first, int last, int stride);

  /// False for one that is not made of times: there is no time to ask for.
  bool isEmpty() const { return this->Numbers.empty(); }

  /// Numbers of all its steps, and of how many they are chosen.
  const std::vector<int>& numbers() const { return this->Numbers; }
  std::vector<double> times() const;
  std::size_t available() const { return this->Times.size(); }

  int number() const { return this->Numbers[this->Position]; } ///< of the present step
  double time() const { return this->Times[static_cast<std::size_t>(this->number())]; }

  /// To the next step; false, and at the first again, when there is none.
  bool advance();
  void rewind() { this->Position = 0; }

  /// Share of the whole that is done when so much of the present step is.
  double progress(double ofStep) const;

private:
  std::vector<double> Times;
  std::vector<int> Numbers;
  std::size_t Position = 0;
};

/// `name` with `suffix` before its extension, in which the number replaces %d, %3d (at least three
/// characters) or %.3d and %03d (digits). Throws inr::Error(InvalidArgument) for a suffix that has
/// not exactly one of these.
std::string StepFileName(const std::string& name, const std::string& suffix, int number);
