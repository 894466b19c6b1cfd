// SPDX-License-Identifier: BSD-3-Clause
//
// Colours as the inner loops of marching look them up. Plain data.
#pragma once

namespace inr {

/// Colours and opacities for the sample lengths of one frame: table + length * rows holds, for
/// samples of StepsOf(length) steps (StepTable.h), `rows` entries of straight RGB and the opacity
/// of the whole sample. Entry 0 and 1 hold what is below the transfer function's range, the last
/// two what is above.
///
/// Where opacity is no line between two entries, the higher of them has SteepEntry times that of a
/// unit distance. What interpolation makes of it is above 1, but at the other entry itself: then
/// the sample's is SteepOpacity.
struct StepLookup
{
  const float* entries; ///< RGBA
  int rows;
  float scale; ///< entry position = scale * y + bias
  float bias;
  float step; ///< of a ray, in opacity unit distances
};

constexpr float SteepEntry = 0x1p100f;

/// The opacity of a sample of the length of this number between two entries, `weight` of the second
/// one, of which one is steep. For kernels, which are compiled once per instruction set.
float SteepOpacityOf(const StepLookup& lookup, int length, float first, float second, float weight);

/// A place of a transfer function from which on, to the next one's, density is linear: extinction
/// times RGB, and extinction, per unit distance.
struct IntegralNode
{
  double integral[4]; ///< of the density over positions, up to here
  float density[4];
  float next[4]; ///< at the next node, or the same where there is none
};

/// Extinction per unit distance from which on a stretch is opaque, however short: an opacity in
/// float is 1 there.
constexpr float OpaqueFrom = 16.635532f; // 24 ln 2

/// The integrals of a frame's colours; see PreIntegratedColors. Node k + 1 is at position k; the
/// first one stands for all positions below 0, and the last one for all above `last`.
struct IntegralLookup
{
  const IntegralNode* nodes;
  int last;
  float scale; ///< position = scale * y + bias
  float bias;
  float step; ///< of a ray, in opacity unit distances
};

} // namespace inr
