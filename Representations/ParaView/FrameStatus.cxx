// SPDX-License-Identifier: BSD-3-Clause
#include "FrameStatus.h"

#include "Readers/Common/Processes.h"
#include "vtkCommunicator.h"
#include "vtkINRVolumeMapper.h"
#include "vtkMultiProcessController.h"

#include <array>
#include <limits>

namespace inr {

FrameStatus StatusOf(vtkINRVolumeMapper* mapper)
{
  FrameStatus status;
  status.drawn = mapper->GetImageReduction() > 0;
  status.converged = mapper->GetConverged();
  status.finest = mapper->GetFinestLevel();
  status.coarsest = mapper->GetCoarsestLevel();
  status.samples = static_cast<double>(mapper->GetNumberOfSamples());
  status.hitRate = mapper->GetCacheHitRate();
  status.clamped = static_cast<double>(mapper->GetNumberOfClampedSamples());
  status.paths = static_cast<double>(mapper->GetNumberOfPaths());
  status.reduction = mapper->GetImageReduction();
  status.cacheMiB = mapper->GetCacheUsed();
  status.seconds = mapper->GetFrameTime();
  return status;
}

FrameStatus StatusOfAll(const FrameStatus& own, vtkMultiProcessController* processes)
{
  if (!AreSeveral(processes)) {
    return own;
  }
  const std::array<double, 4> sums{own.samples, own.hitRate * own.samples, own.cacheMiB,
                                   own.clamped};
  // What is least is the most of its opposite.
  constexpr double none = -std::numeric_limits<double>::max();
  const std::array<double, 8> most{own.drawn ? 1.0 : 0.0,
                                   own.converged ? 0.0 : 1.0,
                                   own.finest >= 0 ? -static_cast<double>(own.finest) : none,
                                   static_cast<double>(own.coarsest),
                                   own.samples > 0 ? -own.paths : none,
                                   own.seconds,
                                   own.samples > 0 ? none : own.hitRate,
                                   static_cast<double>(own.reduction)};
  std::array<double, 4> allSums{};
  std::array<double, 8> allMost{};
  processes->AllReduce(sums.data(), allSums.data(), 4, vtkCommunicator::SUM_OP);
  processes->AllReduce(most.data(), allMost.data(), 8, vtkCommunicator::MAX_OP);
  FrameStatus all;
  all.drawn = allMost[0] > 0;
  all.converged = allMost[1] <= 0;
  all.finest = allMost[2] > none ? static_cast<int>(-allMost[2]) : -1;
  all.coarsest = static_cast<int>(allMost[3]);
  all.samples = allSums[0];
  all.hitRate = allSums[0] > 0 ? allSums[1] / allSums[0] : allMost[6];
  all.paths = allMost[4] > none ? -allMost[4] : 0;
  all.reduction = static_cast<int>(allMost[7]);
  all.cacheMiB = allSums[2];
  all.clamped = allSums[3];
  all.seconds = allMost[5];
  all.processes = processes->GetNumberOfProcesses();
  return all;
}

} // namespace inr
