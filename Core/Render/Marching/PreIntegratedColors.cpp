// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Marching/PreIntegratedColors.h"

#include <algorithm>

namespace inr {

namespace {

constexpr int FewestNodes = 1 << 10;
constexpr int MostNodes = 1 << 14;
constexpr double ExtinctionTolerance = 2e-4; // of the extinction
/// Of what is opaque: enough for a stretch of which 1/3900 is to be so, and little enough that what
/// is faint is not lost in sums with it.
constexpr double OpaqueExtinction = 0x1p16;

double BoundedExtinction(double opacity)
{
  return opacity < 1.0 ? ExtinctionOf(opacity) : OpaqueExtinction;
}

glm::vec4 DensityOf(const glm::vec4& entry)
{
  const double extinction = BoundedExtinction(entry.w);
  return {glm::vec3(glm::dvec3(entry) * extinction), static_cast<float>(extinction)};
}

/// Whether a straight line misses the extinction in the middle between two opacities.
bool IsTooFar(double begin, double end)
{
  const double chord = 0.5 * (BoundedExtinction(begin) + BoundedExtinction(end));
  const double curve = BoundedExtinction(0.5 * (begin + end));
  return std::abs(curve - chord) > ExtinctionTolerance * curve;
}

int NodesPerEntry(const ColorLookup& colors)
{
  const int cells = colors.count - 1;
  int nodes = 1;
  while (nodes * cells < FewestNodes) {
    nodes *= 2;
  }
  for (int k = 0; k < cells; ++k) {
    const double begin = colors.entries[k].w;
    const double end = colors.entries[k + 1].w;
    // It bends most where opacity is high; relatively to itself, never next to 0.
    const double high = std::max(begin, end);
    const double fall = std::abs(end - begin);
    while (nodes * 2 * cells <= MostNodes && IsTooFar(high - fall / nodes, high)) {
      nodes *= 2;
    }
  }
  return nodes;
}

} // namespace

IntegralLookup PreIntegratedLookup::kernelLookup(double step) const
{
  const auto nodes = static_cast<float>(this->NodesPerEntry);
  const bool isLinear = !this->Colors.logarithmic;
  return {this->Nodes, this->Last, isLinear ? nodes * this->Colors.scale : nodes,
          isLinear ? nodes * this->Colors.bias : 0.0f, static_cast<float>(step)};
}

PreIntegratedColors::PreIntegratedColors(const ColorLookup& colors)
{
  const int perEntry = NodesPerEntry(colors);
  const int last = (colors.count - 1) * perEntry;
  this->Nodes.reserve(static_cast<std::size_t>(last) + 2);
  const auto add = [this](const glm::dvec4& integral, const glm::vec4& density) {
    IntegralNode node;
    std::copy_n(&integral.x, 4, node.integral);
    std::copy_n(&density.x, 4, node.density);
    std::copy_n(&density.x, 4, node.next);
    this->Nodes.push_back(node);
  };
  const glm::vec4 below = DensityOf(colors.below);
  add(-glm::dvec4(below), below); // at position -1: those of negative positions are below 0
  glm::dvec4 integral(0.0);
  glm::vec4 density(0.0f);
  for (int k = 0; k <= last; ++k) {
    const int cell = std::min(k / perEntry, colors.count - 2);
    const auto weight = static_cast<float>(k - cell * perEntry) / static_cast<float>(perEntry);
    const glm::vec4 next =
        DensityOf(glm::mix(colors.entries[cell], colors.entries[cell + 1], weight));
    if (k > 0) {
      integral += 0.5 * (glm::dvec4(density) + glm::dvec4(next));
      std::copy_n(&next.x, 4, this->Nodes.back().next);
    }
    density = next;
    add(integral, k < last ? density : glm::vec4(DensityOf(colors.above)));
  }
  this->Lookup.Colors = colors;
  this->Lookup.Nodes = this->Nodes.data();
  this->Lookup.Last = last;
  this->Lookup.NodesPerEntry = perEntry;
}

} // namespace inr
