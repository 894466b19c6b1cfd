// SPDX-License-Identifier: BSD-3-Clause
//
// Section numbers are those of the paper that Flip.h names.
#include "Core/Image/Flip.h"

#include "Core/Error.h"
#include "Core/Image/FlipColors.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace inr {

namespace {

constexpr double Pi = 3.141592653589793;

using Plane = std::vector<double>;
/// Weights of the neighbours at -radius to +radius.
using Weights = std::vector<double>;

/// One channel under a separable filter; beyond its border a picture goes on as it ends there.
class Filter
{
public:
  Filter(int width, int height) : Width(width), Height(height) {}

  Plane apply(const Plane& plane, const Weights& across, const Weights& up) const
  {
    return this->along(this->along(plane, across, 1, this->Width), up, this->Width, this->Height);
  }

private:
  /// Along the axis whose neighbours are `stride` apart and `count` in number.
  Plane along(const Plane& plane, const Weights& weights, std::ptrdiff_t stride,
              std::ptrdiff_t count) const
  {
    const auto radius = static_cast<std::ptrdiff_t>(weights.size() / 2);
    Plane filtered;
    filtered.reserve(plane.size());
    for (const double& middle : plane) {
      const std::ptrdiff_t place = (&middle - plane.data()) / stride % count;
      double sum = 0;
      for (std::ptrdiff_t k = -radius; k <= radius; ++k) {
        const std::ptrdiff_t to = std::clamp<std::ptrdiff_t>(place + k, 0, count - 1) - place;
        sum += weights[static_cast<std::size_t>(k + radius)] * (&middle)[to * stride];
      }
      filtered.push_back(sum);
    }
    return filtered;
  }

  std::ptrdiff_t Width;
  std::ptrdiff_t Height;
};

Weights Sampled(int radius, const std::function<double(double)>& function)
{
  Weights weights;
  for (int k = -radius; k <= radius; ++k) {
    weights.push_back(function(k));
  }
  return weights;
}

/// Scaled so that the positive ones add up to 1, and the negative ones to -1.
Weights Balanced(Weights weights)
{
  double positive = 0;
  double negative = 0;
  for (const double weight : weights) {
    (weight > 0 ? positive : negative) += std::abs(weight);
  }
  for (double& weight : weights) {
    weight /= weight > 0 ? positive : (weight < 0 ? negative : 1.0);
  }
  return weights;
}

/// What an observer sees of a picture: colours without the detail that the eye does not resolve,
/// and how strong its edges and points are.
struct Percept
{
  std::vector<glm::dvec3> colors;
  Plane edges;
  Plane points;
};

/// A Gaussian of a contrast sensitivity's transform: a sqrt(pi/b) exp(-(pi x)^2 / b), x in degrees.
struct Gaussian
{
  double a;
  double b;
};
/// The sensitivity to each opponent channel is the sum of its Gaussians (table 1).
using Sensitivity = Gaussian[2];
constexpr Sensitivity Sensitivities[] = {
    {{1.0, 0.0047}, {0.0, 1.0}}, {{1.0, 0.0053}, {0.0, 1.0}}, {{34.1, 0.04}, {13.5, 0.025}}};
constexpr double WidestGaussian = 0.04;

class Observer
{
public:
  Observer(int width, int height, double pixelsPerDegree)
      : Filters(width, height), PixelsPerDegree(pixelsPerDegree)
  {}

  Percept look(const Image& image) const
  {
    Plane channels[3];
    for (Plane& channel : channels) {
      channel.reserve(image.pixels.size());
    }
    for (std::size_t k = 0; k < image.pixels.size();
         k += static_cast<std::size_t>(image.channels)) {
      const glm::dvec3 display(image.pixels[k], image.pixels[k + 1], image.pixels[k + 2]);
      // Not glm's clamp, which turns a NaN into a number.
      const auto clamped = [](double c) { return std::clamp(c, 0.0, 1.0); };
      const glm::dvec3 opponent =
          OpponentOf(LinearOf({clamped(display.x), clamped(display.y), clamped(display.z)}));
      for (int c = 0; c < 3; ++c) {
        channels[c].push_back(opponent[c]);
      }
    }
    Percept percept;
    this->findFeatures(channels[0], percept);
    for (int c = 0; c < 3; ++c) {
      channels[c] = this->blurred(channels[c], Sensitivities[c]);
    }
    for (std::size_t k = 0; k < channels[0].size(); ++k) {
      const glm::dvec3 linear = LinearOfOpponent({channels[0][k], channels[1][k], channels[2][k]});
      percept.colors.push_back(
          PerceivedColor({std::clamp(linear.x, 0.0, 1.0), std::clamp(linear.y, 0.0, 1.0),
                          std::clamp(linear.z, 0.0, 1.0)}));
    }
    return percept;
  }

private:
  /// A channel as the eye resolves it (section 4.1.1).
  Plane blurred(const Plane& channel, const Sensitivity& sensitivity) const
  {
    const int radius = static_cast<int>(
        std::ceil(3 * std::sqrt(WidestGaussian / (2 * Pi * Pi)) * this->PixelsPerDegree));
    Plane sum(channel.size());
    double total = 0;
    for (const auto& [a, b] : sensitivity) {
      if (a <= 0) {
        continue;
      }
      const Weights weights = Sampled(radius, [this, b = b](double k) {
        const double x = Pi * k / this->PixelsPerDegree;
        return std::exp(-x * x / b);
      });
      const double scale = a * std::sqrt(Pi / b);
      const Plane part = this->Filters.apply(channel, weights, weights);
      std::transform(sum.begin(), sum.end(), part.begin(), sum.begin(),
                     [scale](double all, double one) { return all + scale * one; });
      double row = 0;
      for (const double weight : weights) {
        row += weight;
      }
      total += scale * row * row;
    }
    for (double& value : sum) {
      value /= total;
    }
    return sum;
  }

  /// Lengths of first and second derivatives of the luminance, of features 0.082 degrees wide
  /// (section 4.2).
  void findFeatures(const Plane& opponentY, Percept& percept) const
  {
    Plane luminance(opponentY.size());
    std::transform(opponentY.begin(), opponentY.end(), luminance.begin(),
                   [](double y) { return (y + 16) / 116; });
    const double sigma = 0.5 * 0.082 * this->PixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto bell = [sigma](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
    const Weights smooth = Balanced(Sampled(radius, bell));
    percept.edges = this->lengths(
        luminance, Balanced(Sampled(radius, [&](double x) { return -x * bell(x); })), smooth);
    percept.points = this->lengths(
        luminance,
        Balanced(
            Sampled(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * bell(x); })),
        smooth);
  }

  Plane lengths(const Plane& luminance, const Weights& derivative, const Weights& smooth) const
  {
    Plane across = this->Filters.apply(luminance, derivative, smooth);
    const Plane up = this->Filters.apply(luminance, smooth, derivative);
    std::transform(across.begin(), across.end(), up.begin(), across.begin(),
                   [](double x, double y) { return std::hypot(x, y); });
    return across;
  }

  Filter Filters;
  double PixelsPerDegree;
};

/// Compresses the difference of colours into [0, 1]: most of it for what is below 0.4 of the
/// largest (section 4.1.3).
double ColorError(double distance)
{
  constexpr double exponent = 0.7;
  constexpr double knee = 0.4;
  constexpr double atKnee = 0.95;
  static const double largest =
      std::pow(ColorDistance(PerceivedColor({0, 1, 0}), PerceivedColor({0, 0, 1})), exponent);
  const double error = std::pow(distance, exponent) / largest;
  return error < knee ? error * atKnee / knee : atKnee + (error - knee) / (1 - knee) * (1 - atKnee);
}

void RequireComparable(const Image& a, const Image& b, double pixelsPerDegree)
{
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) {
    throw Error(ErrorCode::InvalidArgument, "images of different sizes cannot be compared");
  }
  if (a.pixels.empty() || (a.channels != 3 && a.channels != 4)) {
    throw Error(ErrorCode::InvalidArgument, "FLIP is defined for RGB and RGBA images");
  }
  if (!(pixelsPerDegree >= 1 && pixelsPerDegree <= 10000)) {
    throw Error(ErrorCode::InvalidArgument, "FLIP needs 1 to 10,000 pixels per degree");
  }
}

} // namespace

double ImageFlip(const Image& reference, const Image& test, double pixelsPerDegree, Image* map)
{
  RequireComparable(reference, test, pixelsPerDegree);
  const Observer observer(reference.width, reference.height, pixelsPerDegree);
  const Percept a = observer.look(reference);
  const Percept b = observer.look(test);
  Image errors(reference.width, reference.height, 1);
  double sum = 0;
  for (std::size_t k = 0; k < a.colors.size(); ++k) {
    const double color = ColorError(ColorDistance(a.colors[k], b.colors[k]));
    const double feature =
        std::sqrt(std::max(std::abs(a.edges[k] - b.edges[k]), std::abs(a.points[k] - b.points[k])) /
                  std::sqrt(2.0));
    const double error = std::pow(color, 1 - feature); // section 4.3
    errors.pixels[k] = static_cast<float>(error);
    sum += error;
  }
  if (map != nullptr) {
    *map = std::move(errors);
  }
  return sum / static_cast<double>(a.colors.size());
}

} // namespace inr
