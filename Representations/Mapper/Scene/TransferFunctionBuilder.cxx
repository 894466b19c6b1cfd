// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/TransferFunctionBuilder.h"

#include "Representations/Mapper/Scene/LogarithmicTable.h"
#include "Representations/Mapper/Scene/TableIntervals.h"

#include <vtkColorTransferFunction.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace inr {
namespace {

constexpr int SmallestTable = 1024;
constexpr int LargestTable = 16384;
/// Places that are looked at for each interval of the largest table, where nodes are closer.
constexpr int MostPerInterval = 64;
/// Of more nodes it is not asked how a function bends there: each would have to be looked at.
constexpr std::size_t MostBends = 64;

/// How far along a table a value is, from 0 to 1.
double PlaceOf(double value, const TransferFunction& table)
{
  return table.logarithmic ? std::log(value / table.low) / std::log(table.high / table.low)
                           : (value - table.low) / (table.high - table.low);
}

double ValueAt(double place, const TransferFunction& table)
{
  return table.logarithmic ? table.low * std::pow(table.high / table.low, place)
                           : table.low + place * (table.high - table.low);
}

/// How a function of values, of three numbers, bends at its nodes inside of a table; steps are
/// none.
template <typename Function>
std::vector<Bend> BendsAt(const std::vector<double>& nodes, const Function& function,
                          const TransferFunction& table)
{
  std::vector<Bend> bends;
  if (nodes.size() > MostBends) {
    return bends;
  }
  constexpr double step = 1.0 / LargestTable;
  for (const double node : nodes) {
    if (node <= table.low || node >= table.high) {
      continue;
    }
    const double place = PlaceOf(node, table);
    const auto at = [&](double steps) {
      return function(ValueAt(std::clamp(place + steps * step, 0.0, 1.0), table));
    };
    const glm::dvec3 change = glm::abs((at(1.25) - at(0.25)) - (at(-0.25) - at(-1.25))) / step;
    bends.push_back({place, std::max({change.x, change.y, change.z})});
  }
  return bends;
}

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
    this->colourAt(value, rgb);
    const double alpha = std::clamp(this->Opacity->GetValue(value), 0.0, 1.0);
    return glm::vec4(rgb[0], rgb[1], rgb[2], alpha);
  }

  /// Whether the colours are on a logarithmic scale, whatever the opacities are.
  bool areLogarithmic() const
  {
    return this->haveLogarithms() && this->Rgb->GetRange()[0] < this->Rgb->GetRange()[1];
  }

  /// Whether opacities of negative values are visibly others than close above 0, where a
  /// logarithmic axis ends.
  bool varyBelowZero() const
  {
    constexpr double visible = 0.002; // half of a step of 8 bits
    const std::vector<double> nodes = NodesOf(this->Opacity);
    const double there = nodes.empty() ? 0 : this->Opacity->GetValue(0);
    return std::any_of(nodes.begin(), nodes.end(), [&](double node) {
      return node < 0 && std::abs(this->Opacity->GetValue(node) - there) > visible;
    });
  }

  /// The same at n places from `low` to `high`, whose cost does not grow with nodes times places.
  std::vector<glm::vec4> evenly(double low, double high, int n) const
  {
    const auto size = static_cast<std::size_t>(n);
    std::vector<double> rgb(3 * size);
    std::vector<double> alpha(size);
    if (this->areLogarithmic()) { // VTK's table would have its places at equal ratios
      this->coloursFromLogarithms(low, high, n, rgb);
    } else if (this->Rgb) {
      this->Rgb->GetTable(low, high, n, rgb.data());
    } else {
      for (int channel = 0; channel < 3; ++channel) {
        this->Gray->GetTable(low, high, n, rgb.data() + channel, 3);
      }
    }
    this->Opacity->GetTable(low, high, n, alpha.data());
    return Functions::joined(rgb, alpha);
  }

  /// The same at places whose logarithms are evenly apart; of colours with a logarithmic scale.
  std::vector<glm::vec4> evenlyInLogarithms(double low, double high, int n) const
  {
    const auto size = static_cast<std::size_t>(n);
    std::vector<double> rgb(3 * size);
    OverLogarithms(this->Rgb)->GetTable(std::log10(low), std::log10(high), n, rgb.data());
    std::vector<double> places(size);
    for (int k = 0; k < n; ++k) {
      places[static_cast<std::size_t>(k)] = low * std::pow(high / low, double(k) / (n - 1));
    }
    places.back() = high; // not beyond by a rounding
    return Functions::joined(rgb, AtRising(this->Opacity, places));
  }

  /// How many intervals of the value or, where that is asked for, of its logarithm the closest
  /// nodes ask for.
  int intervals(double low, double high, bool logarithmic) const
  {
    if (this->areLogarithmic() && !logarithmic) {
      constexpr int peaks = 4; // as the lowest nodes are closest
      return peaks * LargestTable;
    }
    return std::max(IntervalsBetween(NodesOf(this->Opacity), low, high, logarithmic),
                    IntervalsBetween(this->colourNodes(), low, high, logarithmic));
  }

  /// Where they bend within a table, of whose entries nothing is asked.
  std::vector<Bend> bends(const TransferFunction& table) const
  {
    const auto alpha = [&](double value) {
      return glm::dvec3(std::clamp(this->Opacity->GetValue(value), 0.0, 1.0));
    };
    const auto color = [&](double value) {
      glm::dvec3 rgb;
      this->colourAt(value, &rgb.x);
      return rgb;
    };
    std::vector<Bend> bends = BendsAt(NodesOf(this->Opacity), alpha, table);
    for (const Bend& bend : BendsAt(this->colourNodes(), color, table)) {
      bends.push_back(bend);
    }
    return bends;
  }

  std::vector<double> colourNodes() const
  {
    return this->Rgb ? NodesOf(this->Rgb) : NodesOf(this->Gray);
  }

  /// Whether they go on at their ends.
  bool areClamped() const
  {
    const bool colours = this->Rgb ? this->Rgb->GetClamping() != 0 : this->Gray->GetClamping() != 0;
    return colours && this->Opacity->GetClamping() != 0;
  }

  vtkObject* colour() const { return this->Rgb ? static_cast<vtkObject*>(this->Rgb) : this->Gray; }

  vtkColorTransferFunction* Rgb;
  vtkPiecewiseFunction* Gray;
  vtkPiecewiseFunction* Opacity;

private:
  /// By a table over the logarithms: asked for each place, the function would go through its nodes.
  void coloursFromLogarithms(double low, double high, int n, std::vector<double>& rgb) const
  {
    const double* ends = this->Rgb->GetRange();
    const double first = std::log10(ends[0]);
    const double last = std::log10(ends[1]);
    std::vector<double> table(3 * (LargestTable + 1));
    OverLogarithms(this->Rgb)->GetTable(first, last, LargestTable + 1, table.data());
    double outside[2][3];
    this->colourAt(0.5 * ends[0], outside[0]);
    this->colourAt(2 * ends[1], outside[1]);
    for (int k = 0; k < n; ++k) {
      const double value = low + (high - low) * k / (n - 1);
      double* const color = &rgb[3 * static_cast<std::size_t>(k)];
      if (value < ends[0] || value > ends[1]) {
        std::copy_n(outside[value < ends[0] ? 0 : 1], 3, color);
        continue;
      }
      const double place = (std::log10(value) - first) / (last - first) * LargestTable;
      const int cell = std::clamp(static_cast<int>(place), 0, LargestTable - 1);
      const double* const entry = &table[3 * static_cast<std::size_t>(cell)];
      for (int channel = 0; channel < 3; ++channel) {
        color[channel] = entry[channel] + (place - cell) * (entry[channel + 3] - entry[channel]);
      }
    }
  }

  bool haveLogarithms() const
  {
    return this->Rgb && this->Rgb->GetScale() == VTK_CTF_LOG10 && this->Rgb->GetRange()[0] > 0;
  }

  void colourAt(double value, double rgb[3]) const
  {
    if (this->Rgb) {
      // Below the range all is alike, and logarithms end.
      const double place =
          this->haveLogarithms() ? std::max(value, 0.5 * this->Rgb->GetRange()[0]) : value;
      this->Rgb->GetTable(place, place, 1, rgb); // GetColor would be the banded one in ParaView
    } else {
      rgb[0] = rgb[1] = rgb[2] = this->Gray->GetValue(value);
    }
  }

  static std::vector<glm::vec4> joined(const std::vector<double>& rgb,
                                       const std::vector<double>& alpha)
  {
    std::vector<glm::vec4> entries(alpha.size());
    for (std::size_t k = 0; k < alpha.size(); ++k) {
      entries[k] =
          glm::vec4(rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2], std::clamp(alpha[k], 0.0, 1.0));
    }
    return entries;
  }
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

/// From the lowest to the highest node.
Range NodeRange(const Functions& functions, bool logarithmic)
{
  Range range;
  range.extend(functions.Rgb);
  range.extend(functions.Gray);
  const double colourLow = range.low;
  range.extend(functions.Opacity);
  if (logarithmic && range.low <= 0) {
    range.low = colourLow; // but for opacities of negative values, see varyBelowZero
  }
  range.complete();
  return range;
}

/// What of it there are values in; all where there are none, and all of these are alike.
Range SeenOf(const Range& nodes, const ValueSpan& values)
{
  // A single value is seen by what is around it, as narrow as one may care for.
  const double care = 1e-3 * std::min(std::abs(values.low), nodes.high - nodes.low);
  const double around =
      values.low < values.high ? 0 : std::max({care, 1e-15 * std::abs(values.low), 1e-30});
  Range seen;
  seen.low = std::max(nodes.low, values.low - around);
  seen.high = std::min(nodes.high, values.high + around);
  return seen.low < seen.high ? seen : nodes;
}

/// At n places from one end to the other.
std::vector<glm::vec4> Sampled(const Functions& functions, const TransferFunction& table, int n)
{
  std::vector<glm::vec4> entries = table.logarithmic
                                       ? functions.evenlyInLogarithms(table.low, table.high, n)
                                       : functions.evenly(table.low, table.high, n);
  // With clamping off VTK's functions begin behind their first node, and where a rounding is beyond
  // the last place, they may have ended. Logarithms are rounded once more.
  const auto behind = [&](double value) {
    return table.logarithmic ? value * (1 + 1e-12) : std::nextafter(value, table.high);
  };
  const bool begins = table.logarithmic || !functions.areClamped();
  entries.front() = functions.at(begins ? behind(table.low) : table.low);
  entries.back() = functions.at(table.logarithmic ? table.high * (1 - 1e-12) : table.high);
  // Exactly at its first node, VTK's table of a colour function is black.
  const double first =
      functions.Rgb && functions.Rgb->GetSize() > 0 ? functions.Rgb->GetRange()[0] : table.low;
  if (first > table.low && first < table.high) {
    const double position = PlaceOf(first, table) * (n - 1);
    const double nearest = std::round(position);
    if (std::abs(position - nearest) < 1e-6) {
      entries[static_cast<std::size_t>(nearest)] = functions.at(behind(first));
    }
  }
  return entries;
}

/// Every n-th of them, each the mean of those around it, the less the further: a peak between two
/// entries adds to both, and what is linear remains what it is.
std::vector<glm::vec4> Thinned(const std::vector<glm::vec4>& fine, int n)
{
  std::vector<glm::vec4> entries{fine.front()};
  const auto step = static_cast<std::size_t>(n);
  for (std::size_t middle = step; middle + step < fine.size(); middle += step) {
    glm::dvec3 plain(0);
    glm::dvec4 seen(0); // colours by their opacity
    for (int k = 1 - n; k < n; ++k) {
      const glm::dvec4 entry(fine[middle + static_cast<std::size_t>(n + k) - step]);
      const double weight = (n - std::abs(k)) / (static_cast<double>(n) * n);
      plain += weight * glm::dvec3(entry);
      seen += weight * entry.w * glm::dvec4(glm::dvec3(entry), 1.0);
    }
    const glm::dvec3 color = seen.w > 0 ? glm::dvec3(seen) / seen.w : plain;
    entries.emplace_back(glm::vec4(color, seen.w));
  }
  entries.push_back(fine.back());
  return entries;
}

std::vector<glm::vec4> Entries(const Functions& functions, const TransferFunction& table)
{
  const int wanted = functions.intervals(table.low, table.high, table.logarithmic);
  if (wanted > LargestTable) {
    const int finer = std::min(wanted / LargestTable + 1, MostPerInterval);
    return Thinned(Sampled(functions, table, LargestTable * finer + 1), finer);
  }
  const int intervals =
      IntervalsForBends(functions.bends(table), std::max(wanted, SmallestTable), LargestTable);
  return Sampled(functions, table, intervals + 1);
}

} // namespace

TransferFunction BuildTransferFunction(vtkVolumeProperty* property, const ValueSpan& values)
{
  const Functions functions(property);
  TransferFunction result;
  result.logarithmic = functions.areLogarithmic() && !functions.varyBelowZero();
  const Range nodes = NodeRange(functions, result.logarithmic);
  const Range seen = SeenOf(nodes, values);
  result.low = seen.low;
  result.high = seen.high;
  result.table = Entries(functions, result);
  const double ratio = nodes.high / nodes.low;
  const double width = nodes.high - nodes.low;
  // No value is on the side where some of the nodes are not seen.
  result.below = seen.low > nodes.low
                     ? result.table.front()
                     : functions.at(result.logarithmic ? nodes.low / ratio : nodes.low - width);
  result.above = seen.high < nodes.high
                     ? result.table.back()
                     : functions.at(result.logarithmic ? nodes.high * ratio : nodes.high + width);
  return result;
}

TransferFunctionCache::Key TransferFunctionCache::makeKey(vtkVolumeProperty* property,
                                                          const ValueSpan& values)
{
  const Functions functions(property);
  return {functions.colour(), functions.Opacity, functions.colour()->GetMTime(),
          functions.Opacity->GetMTime(), values};
}

const TransferFunction& TransferFunctionCache::get(vtkVolumeProperty* property,
                                                   const ValueSpan& values)
{
  const Key key = TransferFunctionCache::makeKey(property, values);
  if (!(key == this->Built)) {
    this->Table = BuildTransferFunction(property, values);
    this->Built = key;
  }
  return this->Table;
}

} // namespace inr
