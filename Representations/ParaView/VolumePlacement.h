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
  /// Looks again. `piece`: its bounds in the volume. Returns whether the volume is elsewhere than
  /// when this was called last, in all processes alike.
  bool update(vtkINRVolumeMapper& mapper, const double piece[6], vtkMatrix4x4& matrix);

  /// Of the box in the world around the piece. Where the volume is turned, so that such boxes meet,
  /// of the same part of the box around all of it: surfaces would be nobody's between boxes that
  /// meet and, as all processes draw such a volume together, what each has may be any part.
  double* bounds() { return this->Bounds; }

private:
  double Matrix[16] = {}; ///< of the volume in the world
  double Bounds[6] = {};
};

} // namespace inr
