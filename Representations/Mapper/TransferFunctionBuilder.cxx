// SPDX-License-Identifier: BSD-3-Clause
#include "TransferFunctionBuilder.h"

#include <vtkColorTransferFunction.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace inr {
namespace {

constexpr int SmallestTable = 1024;
constexpr int LargestTable = 16384;

/// A property's two functions behind one question: what is at this value?
struct Functions
{
  explicit Functions(vtkVolumeProperty* property)
      : Rgb(property->GetColorChannels() == 3 ? property->GetRGBTransferFunction() : nullptr),
        Gray(this->Rgb ? nullptr : property->GetGrayTransferFunction()),
        Opacity(property->GetScalarOpacity())
  {}

  glm::vec4 at(double value) const
  {
    double rgb[3];
    if (this->Rgb) {
      this->Rgb->GetTable(value, value, 1, rgb); // GetColor would be the banded one in ParaView
    } else {
      rgb[0] = rgb[1] = rgb[2] = this->Gray->GetValue(value);
    }
    const double alpha = std::clamp(this->Opacity->GetValue(value), 0.0, 1.0);
    return glm::vec4(rgb[0], rgb[1], rgb[2], alpha);
  }

  /// The same at n places from `low` to `high`, whose cost does not grow with nodes times places.
  std::vector<glm::vec4> evenly(double low, double high, int n) const
  {
    const auto size = static_cast<std::size_t>(n);
    std::vector<double> rgb(3 * size);
    std::vector<double> alpha(size);
    if (this->Rgb) {
      this->Rgb->GetTable(low, high, n, rgb.data());
    } else {
      for (int channel = 0; channel < 3; ++channel) {
        this->Gray->GetTable(low, high, n, rgb.data() + channel, 3);
      }
    }
    this->Opacity->GetTable(low, high, n, alpha.data());
    std::vector<glm::vec4> entries(size);
    for (std::size_t k = 0; k < size; ++k) {
      entries[k] =
          glm::vec4(rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2], std::clamp(alpha[k], 0.0, 1.0));
    }
    return entries;
  }

  int samples(double low, double high) const
  {
    const int opacity = this->Opacity->EstimateMinNumberOfSamples(low, high);
    const int colour = this->Rgb ? this->Rgb->EstimateMinNumberOfSamples(low, high)
                                 : this->Gray->EstimateMinNumberOfSamples(low, high);
    return std::clamp(std::max(opacity, colour), SmallestTable, LargestTable);
  }

  vtkObject* colour() const { return this->Rgb ? static_cast<vtkObject*>(this->Rgb) : this->Gray; }

  vtkColorTransferFunction* Rgb;
  vtkPiecewiseFunction* Gray;
  vtkPiecewiseFunction* Opacity;
};

struct Range
{
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  template <typename Function> void extend(Function* function)
  {
    if (function && function->GetSize() > 0) {
      this->low = std::min(this->low, function->GetRange()[0]);
      this->high = std::max(this->high, function->GetRange()[1]);
    }
  }
  /// A range of positive length whatever the functions hold.
  void complete()
  {
    if (!(this->low <= this->high)) {
      this->low = 0;
    }
    if (!(this->low < this->high)) {
      this->high = this->low + std::max(1.0, std::abs(this->low));
    }
  }
};

bool IsLogarithmic(const Functions& functions)
{
  return functions.Rgb && functions.Rgb->GetScale() == VTK_CTF_LOG10 &&
         functions.Rgb->GetRange()[0] > 0 &&
         functions.Rgb->GetRange()[0] < functions.Rgb->GetRange()[1];
}

Range TableRange(const Functions& functions, bool logarithmic)
{
  Range range;
  range.extend(functions.Rgb);
  range.extend(functions.Gray);
  const double colourLow = range.low;
  range.extend(functions.Opacity);
  if (logarithmic && range.low <= 0) {
    range.low = colourLow; // an opacity node at or below 0 has no place on a logarithmic axis
  }
  range.complete();
  return range;
}

/// The range, kept just inside: with clamping off VTK's functions end at their outer nodes, and it
/// takes logarithms of its own, rounded once more.
Range Inside(const TransferFunction& table)
{
  const auto inset = [&](double end) {
    return std::max(1e-12 * (table.high - table.low), 1e-14 * std::abs(end));
  };
  Range range;
  range.low = table.logarithmic ? table.low * (1 + 1e-12) : table.low + inset(table.low);
  range.high = std::max(range.low, table.high - inset(table.high));
  return range;
}

std::vector<glm::vec4> Entries(const Functions& functions, const TransferFunction& table, int n)
{
  const Range range = Inside(table);
  if (!table.logarithmic) {
    return functions.evenly(range.low, range.high, n);
  }
  std::vector<glm::vec4> entries;
  entries.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    const double value = table.low * std::pow(table.high / table.low, double(k) / (n - 1));
    entries.push_back(functions.at(std::clamp(value, range.low, range.high)));
  }
  return entries;
}

} // namespace

TransferFunction BuildTransferFunction(vtkVolumeProperty* property)
{
  const Functions functions(property);
  TransferFunction result;
  result.logarithmic = IsLogarithmic(functions);
  const Range range = TableRange(functions, result.logarithmic);
  result.low = range.low;
  result.high = range.high;
  result.table = Entries(functions, result, functions.samples(range.low, range.high) + 1);
  const double ratio = range.high / range.low;
  const double width = range.high - range.low;
  result.below = functions.at(result.logarithmic ? range.low / ratio : range.low - width);
  result.above = functions.at(result.logarithmic ? range.high * ratio : range.high + width);
  return result;
}

TransferFunctionCache::Key TransferFunctionCache::makeKey(vtkVolumeProperty* property)
{
  const Functions functions(property);
  return {functions.colour(), functions.Opacity, functions.colour()->GetMTime(),
          functions.Opacity->GetMTime()};
}

const TransferFunction& TransferFunctionCache::get(vtkVolumeProperty* property)
{
  const Key key = TransferFunctionCache::makeKey(property);
  if (!(key == this->Built)) {
    this->Table = BuildTransferFunction(property);
    this->Built = key;
  }
  return this->Table;
}

} // namespace inr
