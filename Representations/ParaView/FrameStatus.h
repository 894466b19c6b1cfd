// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkINRVolumeMapper;
class vtkMultiProcessController;

namespace inr {

/// How far a volume's latest picture is, whichever processes made parts of it.
struct FrameStatus
{
  bool drawn = false;
  bool converged = false;
  int finest = -1; ///< level that samples came from; -1 when none came from the cache
  int coarsest = -1;
  double samples = 0;
  double hitRate = 0;  ///< part of the samples that came from the level they asked for
  double clamped = 0;  ///< samples that were moved into their macro-cell's range
  double paths = 0;    ///< through each pixel
  int reduction = 1;   ///< of the picture's width and height
  double cacheMiB = 0; ///< of all processes
  double seconds = 0;  ///< of the slowest one
  int processes = 1;
};

/// This process' part.
FrameStatus StatusOf(vtkINRVolumeMapper* mapper);

/// The parts of all processes together; all of them must ask. `own` without others.
FrameStatus StatusOfAll(const FrameStatus& own, vtkMultiProcessController* processes);

} // namespace inr
