// SPDX-License-Identifier: BSD-3-Clause
//
// Trains small volumes whose values are at a limit, for another program to check what their files
// say of themselves: check_stated_error.py.
//
//     write_extremes FOLDER      writes NAME.raw and NAME.inr for each
#include "Core/Error.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Core/Training/Fields.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

namespace {

constexpr glm::i64vec3 Dims(13, 11, 12);

/// From 0 to 1, both of which it takes.
double Wave(std::int64_t k)
{
  const std::int64_t slice = k / (Dims.x * Dims.y);
  const double x = static_cast<double>(k % Dims.x);
  const double y = static_cast<double>(k / Dims.x % Dims.y);
  const double z = static_cast<double>(slice);
  const double wave = std::sin(0.3 * x + 0.2 * y * y / 11) * std::cos(0.35 * z - 0.1 * y);
  return k == 0 ? 0.0 : (k == 1 ? 1.0 : 0.5 + 0.49 * wave);
}

template <class T> using Value = std::function<T(std::int64_t)>;

template <class T>
void Write(const std::string& folder, const char* name, inr::ScalarType type, const Value<T>& value)
{
  Field<T> field{Dims, type, {}};
  for (std::int64_t k = 0; k < field.data().voxels(); ++k) {
    field.values.push_back(value(k));
  }
  inr::TrainingOptions options = Steps(150);
  options.storedAs = inr::ParameterType::Float;
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  inr::WriteModel(*model, folder + "/" + name + ".inr");
  std::ofstream(folder + "/" + name + ".raw", std::ios::binary)
      .write(reinterpret_cast<const char*>(field.values.data()),
             static_cast<std::streamsize>(field.values.size() * sizeof(T)));
}

/// From the least to the largest number of the type.
template <class T> void WriteAllOf(const std::string& folder, inr::ScalarType type)
{
  using Limits = std::numeric_limits<T>;
  Write<T>(folder, inr::ScalarName(type), type, [](std::int64_t k) {
    const double wave = Wave(k);
    const long double range = static_cast<long double>(Limits::max()) - Limits::min();
    return wave == 1.0 ? Limits::max() : static_cast<T>(Limits::min() + range * wave);
  });
}

void WriteFloats(const std::string& folder)
{
  const auto write = [&](const char* name, const Value<float>& value) {
    Write<float>(folder, name, inr::ScalarType::Float32, value);
  };
  write("around_1e-38", [](std::int64_t k) { return static_cast<float>(1e-38 + 3e-38 * Wave(k)); });
  write("around_1e38", [](std::int64_t k) { return static_cast<float>(-1e38 + 3e38 * Wave(k)); });
  write("denormals", [](std::int64_t k) { return static_cast<float>(1e-42 * Wave(k)); });
  write("two_values", [](std::int64_t k) { return k / 40 % 2 == 0 ? -1e-5f : 3e5f; });
  write("constant", [](std::int64_t) { return -1e38f; });
  write("around_zero", [](std::int64_t k) {
    const double wave = 2 * Wave(k) - 1;
    return static_cast<float>(wave * wave * wave * 1e-3);
  });
}

void WriteDoubles(const std::string& folder)
{
  const auto write = [&](const char* name, const Value<double>& value) {
    Write<double>(folder, name, inr::ScalarType::Float64, value);
  };
  write("eighteen_decades", [](std::int64_t k) { return std::pow(10.0, 18 * Wave(k) - 9); });
  write("detail_at_1e9", [](std::int64_t k) { return 1e9 + 1e-4 * Wave(k); });
  write("few_steps_at_1e9", [](std::int64_t k) { return 1e9 + 1e-6 * Wave(k); });
  write("around_1e300", [](std::int64_t k) { return -4e300 + 8e300 * Wave(k); });
}

/// Integers whose differences a double does not see.
void WriteVastIntegers(const std::string& folder)
{
  Write<std::int64_t>(folder, "alike_as_doubles", inr::ScalarType::Int64, [](std::int64_t k) {
    return (std::int64_t{1} << 60) + static_cast<std::int64_t>(100 * Wave(k));
  });
  Write<std::uint64_t>(folder, "few_doubles_apart", inr::ScalarType::UInt64, [](std::int64_t k) {
    return (std::uint64_t{1} << 63) + static_cast<std::uint64_t>(20000 * Wave(k));
  });
}

void WriteAll(const std::string& folder)
{
  std::filesystem::create_directories(folder);
  WriteFloats(folder);
  WriteDoubles(folder);
  WriteVastIntegers(folder);
  WriteAllOf<std::int8_t>(folder, inr::ScalarType::Int8);
  WriteAllOf<std::uint8_t>(folder, inr::ScalarType::UInt8);
  WriteAllOf<std::int16_t>(folder, inr::ScalarType::Int16);
  WriteAllOf<std::uint16_t>(folder, inr::ScalarType::UInt16);
  WriteAllOf<std::int32_t>(folder, inr::ScalarType::Int32);
  WriteAllOf<std::uint32_t>(folder, inr::ScalarType::UInt32);
  WriteAllOf<std::int64_t>(folder, inr::ScalarType::Int64);
  WriteAllOf<std::uint64_t>(folder, inr::ScalarType::UInt64);
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  try {
    WriteAll(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
