// SPDX-License-Identifier: BSD-3-Clause
//
// The command line of the programs beside this file.
#pragma once

#include "Testing/Turbulence/TurbulentChannel.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace inr {

/// What follows a program's name: positional arguments, and options `--name value` in any order.
class Options
{
public:
  /// `known` names the options. Throws Error(InvalidArgument) for others and for one without value.
  Options(int argc, char** argv, const std::vector<std::string>& known);

  const std::vector<std::string>& positional() const { return this->Positional; }
  std::string text(const std::string& name, const std::string& otherwise) const;
  std::int64_t integer(const std::string& name, std::int64_t otherwise) const;
  double number(const std::string& name, double otherwise) const;

private:
  std::vector<std::string> Positional;
  std::map<std::string, std::string> Named;
};

/// A whole number, or Error(InvalidArgument) with what it is called.
std::int64_t ParseInteger(const std::string& text, const std::string& name);

/// The field that --seed, --octaves, --intensity and --time say.
TurbulentChannel::Parameters FieldFrom(const Options& options);

/// A whole `main`: runs `program` with the command line, on which there may be `own` options and
/// those of the field; prints what is thrown and, for wrong arguments, `usage`, too.
int RunProgram(int argc, char** argv, const char* usage, const std::vector<std::string>& own,
               const std::function<void(const Options&)>& program);

} // namespace inr
