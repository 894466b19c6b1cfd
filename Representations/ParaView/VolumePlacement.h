// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkINRVolumeMapper;
class vtkMatrix4x4;

namespace inr {

/// Where this process' piece of a volume is in the world, as a view wants to know it that sorts the
/// processes' pictures by their pieces.
class VolumePlacement
{
public:
  /// Looks again. `piece`: its bounds in the volume, which count where the mapper has no INR.
  /// Returns whether the volume is elsewhere than when this was called last, in all processes
  /// alike.
  bool update(vtkINRVolumeMapper& mapper, const double piece[6], vtkMatrix4x4& matrix);

  /// The same part of the box in the world around all of it, so that neighbours' boxes meet to the
  /// last bit: surfaces would be nobody's between boxes that do not, or overlap. It is the box
  /// around the piece where the volume is not turned and, as all processes draw one that is turned
  /// together, any part there.
  double* bounds() { return this->Bounds; }

private:
  double Matrix[16] = {}; ///< of the volume in the world
  double Bounds[6] = {};
};

} // namespace inr
