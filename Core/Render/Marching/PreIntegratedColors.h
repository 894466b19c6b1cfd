// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Marching/ColorLookups.h"
#include "Core/Render/Scene/ColorTable.h"
#include "Core/Render/Scene/Opacity.h"

#include <glm/gtc/type_ptr.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <vector>

namespace inr {

/// Colours of stretches of a ray along which the field rises or falls linearly from one value to
/// another: what a transfer function has of all the values in between, however thin a peak is.
/// After Engel, Kraus and Ertl, High-Quality Pre-Integrated Volume Rendering Using
/// Hardware-Accelerated Pixel Shading (2001), with the integral functions of its section 3.3: what
/// a stretch emits is as if the rest of it did not hide that. Plain data.
class PreIntegratedLookup
{
public:
  /// Straight RGB and opacity per unit distance of a stretch between two normalised values, in
  /// either order; where they are equal that is ColorLookup::at. A stretch is opaque if
  /// any part of it to speak of is: its mean extinction is OpaqueFrom then. Linear means in
  /// ColorLookup::coordinate, so in the logarithm where that is taken.
  INR_HOST_DEVICE glm::vec4 between(float first, float last) const
  {
    const glm::dvec4 density = this->meanBetween(this->positionOf(first), this->positionOf(last));
    if (!(density.w > 0.0)) {
      return glm::vec4(0.0f);
    }
    const glm::dvec3 color = glm::dvec3(density) / density.w;
    const bool isOpaque = density.w >= static_cast<double>(OpaqueFrom);
    return {glm::vec3(color), isOpaque ? 1.0f : static_cast<float>(OpacityOf(density.w))};
  }

  /// For BrickKernel::compositeIntegrated, with rays' steps of so many opacity unit distances.
  /// Values are to be those of ColorLookup::coordinate for a logarithmic colour table.
  IntegralLookup kernelLookup(double step) const;

  /// For copies: the nodes, and the same of such copies and of a copy of the colours.
  const IntegralNode* nodes() const { return this->Nodes; }
  int nodeCount() const { return this->Last + 2; }
  PreIntegratedLookup with(const ColorLookup& colors, const IntegralNode* nodes) const
  {
    PreIntegratedLookup copy = *this;
    copy.Colors = colors;
    copy.Nodes = nodes;
    return copy;
  }

private:
  friend class PreIntegratedColors;

  INR_HOST_DEVICE double positionOf(float value) const
  {
    return this->NodesPerEntry * static_cast<double>(this->Colors.coordinate(value));
  }

  INR_HOST_DEVICE const IntegralNode& nodeAt(double position) const
  {
    if (!(position >= 0.0)) { // what is no number, too
      return this->Nodes[0];
    }
    if (position > this->Last) {
      return this->Nodes[this->Last + 1];
    }
    const int node = static_cast<int>(position);
    return this->Nodes[(node < this->Last ? node : this->Last - 1) + 1];
  }

  INR_HOST_DEVICE glm::dvec4 meanBetween(double first, double last) const
  {
    const IntegralNode& a = this->nodeAt(first);
    const IntegralNode& b = this->nodeAt(last);
    const Reached begin = this->reach(a, first);
    const Reached end = this->reach(b, last);
    // Of less, too few digits would be left; positions have fewer in float, see the kernel's.
    if (&a == &b || std::abs(last - first) < 1e-3) {
      return 0.5 * (begin.density + end.density);
    }
    const glm::dvec4 between = glm::make_vec4(b.integral) - glm::make_vec4(a.integral);
    return (between + (end.integral - begin.integral)) / (last - first);
  }

  /// Density at a position, and its integral from the node before to there.
  struct Reached
  {
    glm::dvec4 density;
    glm::dvec4 integral;
  };
  INR_HOST_DEVICE Reached reach(const IntegralNode& node, double position) const
  {
    const double way = position - static_cast<double>(&node - this->Nodes - 1);
    const glm::dvec4 begin = glm::make_vec4(node.density);
    const glm::dvec4 density = begin + (glm::dvec4(glm::make_vec4(node.next)) - begin) * way;
    return {density, (begin + density) * (0.5 * way)};
  }

  ColorLookup Colors;
  const IntegralNode* Nodes = nullptr;
  int Last = 0;             ///< position
  double NodesPerEntry = 1; ///< of the colour table
};

/// The integrals of a colour table. From one node to the next density is taken to be linear, and
/// between two entries of the table there are as many nodes as extinction needs for that, within
/// 2e-4 of it: 1024 in all at least, and no more than 2^14 if the table has not more itself. Where
/// colour changes with opacity from each entry to the next, it is off by 1/6 of that change between
/// nodes.
class PreIntegratedColors
{
public:
  /// `colors` must outlive it.
  explicit PreIntegratedColors(const ColorLookup& colors);
  PreIntegratedColors(const PreIntegratedColors&) = delete;
  PreIntegratedColors& operator=(const PreIntegratedColors&) = delete;

  const PreIntegratedLookup& lookup() const { return this->Lookup; }

private:
  std::vector<IntegralNode> Nodes; ///< see IntegralLookup
  PreIntegratedLookup Lookup;
};

} // namespace inr
