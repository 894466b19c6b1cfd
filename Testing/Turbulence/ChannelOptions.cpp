// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/ChannelOptions.h"

#include "Core/Error.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <iostream>

namespace inr {
namespace {

template <class T> T Parse(const std::string& text, const std::string& name)
{
  T value{};
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) {
    throw Error(ErrorCode::InvalidArgument, name + ": '" + text + "' is no number that fits");
  }
  return value;
}

} // namespace

Options::Options(int argc, char** argv, const std::vector<std::string>& known)
{
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument.rfind("--", 0) != 0) {
      this->Positional.push_back(argument);
      continue;
    }
    if (std::find(known.begin(), known.end(), argument) == known.end()) {
      throw Error(ErrorCode::InvalidArgument, "there is no option " + argument);
    }
    if (++k == argc) {
      throw Error(ErrorCode::InvalidArgument, argument + " lacks its value");
    }
    this->Named[argument] = argv[k];
  }
}

std::string Options::text(const std::string& name, const std::string& otherwise) const
{
  const auto found = this->Named.find(name);
  return found == this->Named.end() ? otherwise : found->second;
}

std::int64_t Options::integer(const std::string& name, std::int64_t otherwise) const
{
  const auto found = this->Named.find(name);
  return found == this->Named.end() ? otherwise : ParseInteger(found->second, name);
}

double Options::number(const std::string& name, double otherwise) const
{
  const auto found = this->Named.find(name);
  return found == this->Named.end() ? otherwise : Parse<double>(found->second, name);
}

std::int64_t ParseInteger(const std::string& text, const std::string& name)
{
  return Parse<std::int64_t>(text, name);
}

TurbulentChannel::Parameters FieldFrom(const Options& options)
{
  TurbulentChannel::Parameters field;
  field.seed = static_cast<std::uint64_t>(options.integer("--seed", 1));
  const std::int64_t octaves = options.integer("--octaves", field.octaves);
  field.octaves = static_cast<int>(octaves); // judged by the field
  if (field.octaves != octaves) {
    throw Error(ErrorCode::InvalidArgument,
                "a turbulent channel has 1 to 8 octaves, not " + std::to_string(octaves));
  }
  field.intensity = options.number("--intensity", field.intensity);
  field.time = options.number("--time", field.time);
  return field;
}

int RunProgram(int argc, char** argv, const char* usage, const std::vector<std::string>& own,
               const std::function<void(const Options&)>& program)
{
  try {
    std::vector<std::string> known = {"--seed", "--octaves", "--intensity", "--time"};
    known.insert(known.end(), own.begin(), own.end());
    program(Options(argc, argv, known));
  } catch (const Error& error) {
    std::cerr << error.what() << "\n";
    if (error.code() == ErrorCode::InvalidArgument) {
      std::cerr << usage;
      return 2;
    }
    return 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}

} // namespace inr
