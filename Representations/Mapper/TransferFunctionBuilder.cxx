// SPDX-License-Identifier: BSD-3-Clause
#include "TransferFunctionBuilder.h"

#include <vtkColorTransferFunction.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The value of entry k of n, kept just inside (low, high): with clamping off VTK's functions end
/// at their outer nodes, and it takes logarithms of its own, rounded once more.
double EntryValue(const TransferFunction& table, int k, int n)
{
  const double t = static_cast<double>(k) / (n - 1);
  const double value = table.logarithmic ? table.low * std::pow(table.high / table.low, t)
                                         : table.low + (table.high - table.low) * t;
  const auto inset = [&](double end) {
    return std::max(1e-12 * (table.high - table.low), 1e-14 * std::abs(end));
  };
  const double first = table.logarithmic ? table.low * (1 + 1e-12) : table.low + inset(table.low);
  return std::clamp(value, first, std::max(first, table.high - inset(table.high)));
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
  const int n = functions.samples(range.low, range.high) + 1;
  result.table.reserve(n);
  for (int k = 0; k < n; ++k) {
    result.table.push_back(functions.at(EntryValue(result, k, n)));
  }
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
