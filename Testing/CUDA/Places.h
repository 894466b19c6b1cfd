// SPDX-License-Identifier: BSD-3-Clause
//
// Where the kernels run in a test: on the host, and on this machine's GPU where there is one.
#pragma once

#include "CUDA/Render/Renderers.h"
#include "Testing/CUDA/Emulated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

enum class Place { Host, Gpu };

inline const char* TextOf(Place place) { return place == Place::Host ? "Host" : "Gpu"; }

inline void PrintTo(Place place, std::ostream* stream) { *stream << TextOf(place); }

/// The last thing that SetUp does: skips, with the reason, where there is no such place.
inline void SkipUnlessThere(Place place)
{
  const inr::cuda::Devices devices = inr::cuda::FindDevices();
  if (place == Place::Gpu && devices.usable.empty()) {
    GTEST_SKIP() << devices.reason;
  }
}

/// Tests that run in every place.
class InAPlace : public testing::TestWithParam<Place>
{
public:
  static std::string nameOf(const testing::TestParamInfo<Place>& info)
  {
    return TextOf(info.param);
  }

protected:
  void SetUp() override { SkipUnlessThere(GetParam()); }
};

struct Setting
{
  Place place;
  inr::cuda::Precision precision;

  bool half() const { return this->precision == inr::cuda::Precision::Half; }
};

inline std::ostream& operator<<(std::ostream& stream, const Setting& setting)
{
  const bool plain = setting.precision == inr::cuda::Precision::Plain;
  return stream << TextOf(setting.place)
                << (setting.half() ? "Half" : (plain ? "Plain" : "Float32"));
}

inline std::string NameOf(const testing::TestParamInfo<Setting>& info)
{
  return testing::PrintToString(info.param);
}

inline std::vector<Setting> AllSettings()
{
  using inr::cuda::Precision;
  return {{Place::Host, Precision::Half},   {Place::Host, Precision::Float32},
          {Place::Host, Precision::Plain},  {Place::Gpu, Precision::Half},
          {Place::Gpu, Precision::Float32}, {Place::Gpu, Precision::Plain}};
}

/// The same in every precision.
class InEveryPlace : public testing::TestWithParam<Setting>
{
protected:
  void SetUp() override { SkipUnlessThere(GetParam().place); }

  /// Where some samples are Core's to compute.
  static HostLaunch Overflowing()
  {
    HostLaunch launch;
    launch.overflows = true;
    return launch;
  }

  static std::shared_ptr<const inr::Evaluator> evaluator(const inr::ModelPointer& model,
                                                         HostLaunch launch = {})
  {
    if (GetParam().place == Place::Gpu) {
      return inr::cuda::MakeEvaluator(onGpu(model));
    }
    return std::make_shared<EmulatedEvaluator>(
        std::make_shared<EmulatedModel>(model, GetParam().precision, launch));
  }

  static std::shared_ptr<const inr::BrickSource>
  bricks(const inr::ModelPointer& model, const inr::Hierarchy& levels, HostLaunch launch = {})
  {
    if (GetParam().place == Place::Gpu) {
      return inr::cuda::MakeBrickSource(onGpu(model), levels);
    }
    return std::make_shared<EmulatedBricks>(
        std::make_shared<EmulatedModel>(model, GetParam().precision, launch), levels);
  }

private:
  static std::shared_ptr<const inr::cuda::DeviceModel> onGpu(const inr::ModelPointer& model)
  {
    return inr::cuda::UploadModel(model, inr::cuda::ChooseDevice(), GetParam().precision);
  }
};

/// The 99.9th percentile of |a - b| / ((|a| + |b|)/2 + m), m the mean magnitude of `expected`: a
/// symmetric relative error that a value near zero, where terms cancel, does not blow up.
template <class Expected>
double RelativeError(const std::vector<float>& values, const std::vector<Expected>& expected)
{
  double mean = 0;
  for (const Expected value : expected) {
    mean += std::abs(static_cast<double>(value)) / static_cast<double>(expected.size());
  }
  std::vector<double> errors;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double a = values[k];
    const double b = static_cast<double>(expected[k]);
    const double error = std::abs(a - b) / ((std::abs(a) + std::abs(b)) / 2 + mean);
    errors.push_back(std::isnan(error) ? INFINITY : error);
  }
  const std::size_t place = errors.size() - 1 - errors.size() / 1000;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(place),
                   errors.end());
  return errors[place];
}
