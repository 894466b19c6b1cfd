// SPDX-License-Identifier: BSD-3-Clause
//
// Training on volumes whose values or shape are at a limit: nothing diverges, nothing is NaN, and
// what the model says of itself is true.
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/ModelFile.h"
#include "Core/Random.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/Training/FieldReader.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <functional>
#include <limits>

namespace test::bad_volumes {

constexpr double Infinity = std::numeric_limits<double>::infinity();

/// A volume by its values: a function of a voxel's number and of a random number in [0, 1).
struct BadVolume
{
  const char* name;
  inr::ScalarType type;
  glm::i64vec3 dims;
  std::function<double(std::int64_t, double)> value;
};

std::ostream& operator<<(std::ostream& out, const BadVolume& volume) { return out << volume.name; }

std::function<double(std::int64_t, double)> Noise(double low, double high)
{
  return [low, high](std::int64_t, double unit) { return low + (high - low) * unit; };
}

/// A wave along x between two values.
std::function<double(std::int64_t, double)> Wave(double low, double high)
{
  return [low, high](std::int64_t k, double) {
    return low + (high - low) * (0.5 + 0.5 * std::sin(0.4 * static_cast<double>(k % 12)));
  };
}

double TwoValues(std::int64_t k, double) { return k / 12 % 2 == 0 ? -3e-5 : 7e4; }

double OneOutlier(std::int64_t k, double) { return k == 700 ? 1e38 : 1.0; }

double GapsAndLimits(std::int64_t k, double unit)
{
  const double odd[] = {NAN, Infinity, -Infinity, FLT_MAX, -FLT_MAX};
  return k % 7 == 0 ? odd[k / 7 % 5] : 1e38 * std::sin(0.3 * static_cast<double>(k % 12)) + unit;
}

constexpr inr::ScalarType Float = inr::ScalarType::Float32;
constexpr inr::ScalarType Double = inr::ScalarType::Float64;

const BadVolume AllVolumes[] = {
    {"one_line", Float, {1, 1, 40}, Noise(-1, 1)},
    {"one_sheet", Float, {1, 17, 23}, Wave(0, 1)},
    {"two_sheets", Float, {2, 13, 11}, Wave(-5, 5)},
    {"two_voxels", Float, {1, 2, 1}, [](std::int64_t k, double) { return k == 0 ? 3.0 : 8.0; }},
    {"noise", Float, {12, 12, 12}, Noise(0, 1)},
    {"noise_of_bytes", inr::ScalarType::UInt8, {12, 12, 12}, Noise(0, 255)},
    {"around_1e_38", Float, {12, 12, 12}, Wave(1e-38, 3e-38)},
    {"around_1e38", Float, {12, 12, 12}, Wave(1e38, 3e38)},
    {"all_of_float", Float, {12, 12, 12}, Wave(-FLT_MAX, FLT_MAX)},
    {"around_1e_300", Double, {12, 12, 12}, Wave(-1e-300, 2e-300)},
    {"around_1e300", Double, {12, 12, 12}, Wave(1e300, 4e300)},
    {"all_of_double", Double, {12, 12, 12}, Wave(-8.9e307, 8.9e307)},
    {"denormal_floats", Float, {12, 12, 12}, Wave(-1e-43, 1e-40)},
    {"few_denormal_doubles", Double, {12, 12, 12}, Wave(0, 1e-322)},
    {"neighbouring_floats", Float, {12, 12, 12}, Wave(1, 1 + 0x1p-22)},
    {"two_values", Float, {12, 12, 12}, TwoValues},
    {"one_outlier", Float, {12, 12, 12}, OneOutlier},
    {"gaps_and_limits", Float, {12, 12, 12}, GapsAndLimits},
};

template <class T> Field<T> Make(const BadVolume& volume)
{
  Field<T> field{volume.dims, volume.type, {}};
  const std::int64_t voxels = volume.dims.x * volume.dims.y * volume.dims.z;
  for (std::int64_t k = 0; k < voxels; ++k) {
    const double unit = inr::RandomUnit(11, static_cast<std::uint64_t>(k));
    field.values.push_back(static_cast<T>(volume.value(k, unit)));
  }
  return field;
}

/// NaN is equal to NaN.
bool Same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void ExpectSameQuality(const inr::Quality& a, const inr::Quality& b)
{
  EXPECT_TRUE(Same(a.psnr, b.psnr)) << a.psnr << " " << b.psnr;
  EXPECT_TRUE(Same(a.ssim, b.ssim)) << a.ssim << " " << b.ssim;
  EXPECT_TRUE(Same(a.maxError, b.maxError)) << a.maxError << " " << b.maxError;
}

void ExpectFinite(const inr::Model& model)
{
  for (const float parameter : model.parameters) {
    ASSERT_TRUE(std::isfinite(parameter));
  }
  for (const inr::ValueRange& range : model.macroCells.ranges) {
    ASSERT_TRUE(range.low >= 0 && range.low <= range.high && range.high <= 1);
  }
  EXPECT_TRUE(std::isfinite(model.volume.low) && std::isfinite(model.volume.high));
}

/// Finite voxels in units of the range, and the best that one number for all of them could do.
struct Normalised
{
  template <class T> Normalised(const Field<T>& field, const inr::VolumeInfo& info)
  {
    long double sum = 0;
    for (const T value : field.values) {
      const auto low = static_cast<long double>(info.low);
      this->Values.push_back((static_cast<long double>(value) - low) / (info.high - low));
      if (std::isfinite(this->Values.back())) {
        sum += this->Values.back();
        ++this->Known;
      }
    }
    const std::vector<float> mean(field.values.size(),
                                  static_cast<float>(sum / static_cast<long double>(this->Known)));
    this->ConstantPsnr = this->against(mean).psnr;
  }

  inr::Quality against(const std::vector<float>& decoded) const
  {
    long double squared = 0;
    long double largest = 0;
    for (std::size_t k = 0; k < decoded.size(); ++k) {
      if (std::isfinite(this->Values[k])) {
        const long double error = std::abs(this->Values[k] - inr::NormalisedOutput(decoded[k]));
        squared += error * error;
        largest = std::max(largest, error);
      }
    }
    const long double mean = squared / static_cast<long double>(this->Known);
    return {static_cast<double>(-10 * std::log10(mean)), 0, static_cast<double>(largest)};
  }

  std::vector<long double> Values;
  std::int64_t Known = 0;
  double ConstantPsnr = 0;
};

std::vector<float> Decode(const inr::ModelPointer& model)
{
  const glm::i64vec3 dims = model->volume.dims;
  std::vector<glm::vec3> centres;
  for (std::int64_t k = 0; k < dims.x * dims.y * dims.z; ++k) {
    const glm::dvec3 voxel(k % dims.x, k / dims.x % dims.y, k / (dims.x * dims.y));
    centres.emplace_back((voxel + 0.5) / glm::dvec3(dims));
  }
  std::vector<float> values(centres.size());
  inr::MakeEvaluator(model, "baseline")
      ->evaluate(centres.data(), static_cast<std::int64_t>(centres.size()), values.data());
  return values;
}

void ExpectSameFromFile(const inr::Model& model)
{
  const TemporaryFolder folder;
  inr::WriteModel(model, folder.file("bad.inr"));
  const inr::ModelPointer read = inr::ReadModel(folder.file("bad.inr"));
  EXPECT_EQ(read->parameters, model.parameters);
  EXPECT_EQ(read->volume.low, model.volume.low);
  EXPECT_EQ(read->volume.high, model.volume.high);
  ExpectSameQuality(*read->quality, *model.quality);
}

template <class T> void CheckVolume(const BadVolume& volume)
{
  const Field<T> field = Make<T>(volume);
  inr::TrainingOptions options = Steps(80);
  options.threads = 1;
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  options.threads = 2;
  const inr::ModelPointer again = inr::TrainModel(field.data(), {}, options);
  EXPECT_EQ(model->parameters, again->parameters);
  ExpectSameQuality(*model->quality, *again->quality);

  ExpectFinite(*model);
  const Normalised reference(field, model->volume);
  const inr::Quality measured = reference.against(Decode(model));
  const double range = model->volume.high - model->volume.low;
  if (model->quality->psnr != measured.psnr) { // as infinite ones are
    EXPECT_NEAR(model->quality->psnr, measured.psnr, 0.01);
  }
  EXPECT_NEAR(model->quality->maxError, measured.maxError * range, 1e-3 * range + 5e-324);
  EXPECT_GT(model->quality->psnr, reference.ConstantPsnr - 0.05);
  const bool windows = glm::all(glm::greaterThanEqual(volume.dims, glm::i64vec3(7)));
  EXPECT_EQ(windows && model->training->nonFinite == 0, !std::isnan(model->quality->ssim));
  ExpectSameFromFile(*model);
}

class BadVolumes : public testing::TestWithParam<BadVolume>
{};

TEST_P(BadVolumes, TrainToWhatTheModelSays)
{
  switch (GetParam().type) {
  case inr::ScalarType::UInt8:
    return CheckVolume<std::uint8_t>(GetParam());
  case inr::ScalarType::Float64:
    return CheckVolume<double>(GetParam());
  default:
    return CheckVolume<float>(GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, BadVolumes, testing::ValuesIn(AllVolumes),
                         [](const testing::TestParamInfo<BadVolume>& info) {
                           return info.param.name;
                         });

template <class T> void ExpectExact(inr::ScalarType type, const glm::i64vec3& dims, double value)
{
  const Field<T> field =
      Make<T>({"constant", type, dims, [=](std::int64_t, double) { return value; }});
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, Steps(5));
  ExpectFinite(*model);
  for (const float y : Decode(model)) {
    ASSERT_EQ(inr::ValueOf(model->volume, inr::NormalisedOutput(y)),
              static_cast<double>(static_cast<T>(value)));
  }
  EXPECT_EQ(model->quality->psnr, Infinity);
  ExpectSameFromFile(*model);
}

TEST(ConstantVolumes, AreExactWhateverTheNumberAndTheShape)
{
  for (const glm::i64vec3& dims : {glm::i64vec3(1), {1, 5, 9}, {8, 8, 8}}) {
    for (const double value : {0.0, -0.0, 1e38, -1e-38, 1e-45, double{FLT_MAX}}) {
      ExpectExact<float>(Float, dims, value);
    }
    for (const double value : {1e300, -1e-300, 5e-324, -DBL_MAX}) {
      ExpectExact<double>(Double, dims, value);
    }
  }
}

/// Two values may be all but equal and still be told apart.
TEST(ConstantVolumes, OfIntegersThatNoDoubleIs)
{
  const auto check = [](inr::ScalarType type, auto value, auto last) {
    Field<decltype(value)> field = Make<decltype(value)>(
        {"constant", type, {8, 8, 8}, [](std::int64_t, double) { return 0.0; }});
    std::fill(field.values.begin(), field.values.end(), value);
    field.values.back() = last;
    return inr::TrainModel(field.data(), {}, Steps(5));
  };
  constexpr std::int64_t odd = (std::int64_t{1} << 53) + 1;
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  const inr::ModelPointer model = check(inr::ScalarType::Int64, odd, odd);
  EXPECT_EQ(model->training->steps, 0u);
  EXPECT_EQ(inr::ValueOf(model->volume, 0.0f), static_cast<double>(odd - 1));
  EXPECT_EQ(model->quality->maxError, 1);
  EXPECT_TRUE(std::isnan(model->quality->psnr) && std::isnan(model->quality->ssim));
  ExpectSameFromFile(*model);
  EXPECT_EQ(check(inr::ScalarType::UInt64, ones, ones)->training->steps, 0u);
  EXPECT_EQ(check(inr::ScalarType::UInt64, ones, ones - 1)->training->steps, 0u);
  EXPECT_EQ(check(inr::ScalarType::Int64, odd - 1, odd + 1)->training->steps, 5u);
  EXPECT_EQ(check(inr::ScalarType::Int64, odd, odd + 1)->training->steps, 5u);
}

/// Not the double below them.
TEST(ConstantVolumes, AreTheNearestDouble)
{
  constexpr std::int64_t exact = std::int64_t{1} << 60; // doubles are 256 apart
  const auto expect = [](std::int64_t value, std::int64_t last, std::int64_t stored, double error) {
    for (const std::int64_t sign : {1, -1}) {
      Field<std::int64_t> field{{8, 9, 10}, inr::ScalarType::Int64, {}};
      field.values.assign(720, sign * value);
      field.values[700] = sign * last;
      FieldReader<std::int64_t> reader(field);
      for (const inr::ModelPointer& model :
           {inr::TrainModel(field.data(), {}, Steps(5)), inr::TrainModel(reader, {}, Steps(5))}) {
        EXPECT_EQ(model->training->steps, 0u);
        EXPECT_EQ(model->volume.low, static_cast<double>(sign * stored));
        EXPECT_EQ(model->volume.high, model->volume.low);
        EXPECT_EQ(model->quality->maxError, error);
      }
    }
  };
  expect(exact, exact, exact, 0);
  expect(exact + 1, exact + 1, exact, 1);
  expect(exact + 255, exact + 255, exact + 256, 1);
  expect(exact + 5, exact + 200, exact, 200);
  expect(exact + 100, exact + 255, exact + 256, 156);
}

TEST(ConstantVolumes, HaveTheRangeOfWhatTheNetworkSays)
{
  inr::TrainingOptions options = Steps(5);
  options.description = inr::ChooseDescription({24, 20, 17}, Float, 0);
  options.description->network.outputActivation = inr::Activation::Sigmoid;
  Field<float> field = WaveField();
  std::fill(field.values.begin(), field.values.end(), 3.0f);
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  EXPECT_EQ(Decode(model).front(), 0.5f);
  for (const inr::ValueRange& range : model->macroCells.ranges) {
    EXPECT_EQ(range.low, 0.5f);
    EXPECT_EQ(range.high, 0.5f);
  }
}

/// Whether a network of exponentials of exponentials says that it diverged, when it is stopped
/// after so many steps; otherwise its numbers must be numbers.
bool Diverges(int hiddenLayers, std::uint64_t steps)
{
  inr::TrainingOptions options = Steps(steps);
  options.description = inr::ChooseDescription({24, 20, 17}, Float, 0);
  options.description->network.activation = inr::Activation::Exponential;
  options.description->network.outputActivation = inr::Activation::Exponential;
  options.description->network.hiddenLayers = hiddenLayers;
  try {
    const inr::ModelPointer model = inr::TrainModel(WaveField().data(), {}, options);
    ExpectFinite(*model);
    EXPECT_TRUE(std::isfinite(model->quality->psnr) && std::isfinite(model->quality->maxError));
    return false;
  } catch (const inr::Error& error) {
    EXPECT_EQ(error.code(), inr::ErrorCode::InvalidModel);
    return true;
  }
}

/// The last update is followed by no loss that would tell.
TEST(Divergence, IsSaidWhateverTheStepItComesIn)
{
  int diverged = 0;
  int trained = 0;
  for (const int layers : {1, 3, 4, 5}) {
    for (std::uint64_t steps = 1; steps <= 4; ++steps) {
      Diverges(layers, steps) ? ++diverged : ++trained;
    }
  }
  EXPECT_GT(diverged, 0);
  EXPECT_GT(trained, 0);
}

} // namespace test::bad_volumes
