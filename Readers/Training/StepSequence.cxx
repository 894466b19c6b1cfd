// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/StepSequence.h"

#include "Core/Error.h"

#include <filesystem>
#include <regex>
#include <utility>

StepSequence::StepSequence(std::vector<double> times, int first, int last, int stride)
    : Times(std::move(times))
{
  const int count = static_cast<int>(this->Times.size());
  const int end = last < first || last >= count ? count - 1 : last;
  for (std::int64_t number = first; number <= end; number += stride) {
    this->Numbers.push_back(static_cast<int>(number));
  }
  if (this->Numbers.empty()) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "the first time step to write is number " + std::to_string(first) +
                         ", and the input's last one is number " + std::to_string(count - 1));
  }
}

std::vector<double> StepSequence::times() const
{
  std::vector<double> times;
  for (const int number : this->Numbers) {
    times.push_back(this->Times[static_cast<std::size_t>(number)]);
  }
  return times;
}

bool StepSequence::advance()
{
  ++this->Position;
  const bool there = this->Position < this->Numbers.size();
  this->Position = there ? this->Position : 0;
  return there;
}

double StepSequence::progress(double ofStep) const
{
  return this->isEmpty() ? ofStep
                         : (static_cast<double>(this->Position) + ofStep) /
                               static_cast<double>(this->Numbers.size());
}

std::string StepFileName(const std::string& name, const std::string& suffix, int number)
{
  std::smatch parts;
  if (!std::regex_match(suffix, parts, std::regex("([^%/]*)%([.0]?)([0-9]?)d([^%/]*)"))) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "the FileNameSuffix '" + suffix +
                         "' must have one %d in it, or %.3d for three digits (up to 9), and "
                         "no other % or /");
  }
  const std::size_t width = parts[3].length() > 0 ? std::stoul(parts[3]) : 0;
  const std::string digits = std::to_string(number);
  const char fill = parts[2].length() > 0 ? '0' : ' ';
  const std::string padding(width > digits.size() ? width - digits.size() : 0, fill);
  const std::filesystem::path path(name);
  std::filesystem::path result = path.parent_path() / path.stem();
  result += parts[1].str() + padding + digits + parts[4].str();
  result += path.extension();
  return result.string();
}
