// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// A field that looks like the streamwise velocity of turbulent channel flow, known exactly at
/// every point: a mean profile between two walls and random plane waves of several octaves, whose
/// energy falls as the wave number to the power -5/3. It solves no equation of motion.
///
/// x is streamwise, y spanwise (both periodic), z runs from wall to wall. Positions are in the
/// unit cube, so that the field is the same at any resolution; the channel it stands for measures
/// `Size` half-heights. Structures are longer in x than across, lean downstream, and are finer and
/// smaller near the walls, where they vanish. Values are in units of the mean velocity in the
/// middle, about 0 to 1.3.
class TurbulentChannel
{
public:
  static constexpr glm::dvec3 Size{25.132741228718345, 9.42477796076938, 2.0}; ///< 8 pi, 3 pi, 2

  struct Parameters
  {
    std::uint64_t seed = 1;
    /// Octaves of wave numbers across the stream, from 2 per half-height on, 1 to 8. The smallest
    /// structures are 2 pi/2^(octaves + 1) half-heights wide: 40 voxels of 7,680 for 6 octaves.
    int octaves = 6;
    double intensity = 0.06; ///< root mean square of the fluctuations where nothing damps them
    double time = 0;         ///< in half-heights over velocity in the middle
  };

  /// Throws Error(InvalidArgument) for numbers out of range.
  explicit TurbulentChannel(const Parameters& parameters);

  const Parameters& parameters() const { return this->Chosen; }

  /// The value at `u` in the unit cube: the plain sum over all modes, in float64.
  double at(const glm::dvec3& u) const;

  /// Of the mean profile alone, at height `z` in the unit cube.
  static double mean(double z);

  /// A wave amplitude * cos(2 pi (nx x + ny y) + phase), where amplitude and phase depend on z.
  struct Mode
  {
    int nx;           ///< waves along x in the unit cube
    int ny;           ///< and along y, of either sign
    double across;    ///< wave number across the stream, per half-height
    double vertical;  ///< wave number along z, per half-height, in the middle
    double amplitude; ///< where nothing damps it
    double phase;
  };
  /// Mode ChannelWaves * group + w has the w-th of the streamwise wave numbers.
  const std::vector<Mode>& modes() const { return this->Modes; }

  /// What becomes of modes at a height z in the unit cube.
  class Height
  {
  public:
    explicit Height(double z);
    /// Amplitude (x) and phase (y).
    glm::dvec2 of(const Mode& mode) const;

    double distance() const { return this->Distance; }
    double stretched() const { return this->Stretched; }
    double strength() const { return this->Strength; } ///< that all modes share

  private:
    double Distance;  ///< from the nearer wall in half-heights, smooth in the middle: 1/2 there
    double Stretched; ///< from the middle, finer near the walls
    double Strength;
  };

private:
  Parameters Chosen;
  std::vector<Mode> Modes;
};

} // namespace inr
