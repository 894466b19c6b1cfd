// SPDX-License-Identifier: BSD-3-Clause
#include "ThreadShare.h"

#include "Core/Parallel.h"
#include "vtkMultiProcessController.h"
#include "vtkType.h"

#include <algorithm>
#include <vector>

namespace inr {

namespace {

/// Of all processes, in their order.
std::vector<vtkTypeUInt64> Gather(vtkMultiProcessController* controller, std::uint64_t mine)
{
  const auto own = static_cast<vtkTypeUInt64>(mine);
  std::vector<vtkTypeUInt64> all(1, own);
  if (controller && controller->GetNumberOfProcesses() > 1) {
    all.resize(static_cast<std::size_t>(controller->GetNumberOfProcesses()));
    controller->AllGather(&own, all.data(), 1);
  }
  return all;
}

} // namespace

int ThreadShare(vtkMultiProcessController* controller)
{
  const std::uint64_t own = AvailableCoresKey();
  const std::vector<vtkTypeUInt64> all = Gather(controller, own);
  const auto sharing = std::count(all.begin(), all.end(), static_cast<vtkTypeUInt64>(own));
  return std::max(1, AvailableCores() / std::max(1, static_cast<int>(sharing)));
}

int LocalRank(vtkMultiProcessController* controller)
{
  const std::uint64_t machine = MachineKey();
  const std::vector<vtkTypeUInt64> all = Gather(controller, machine);
  const int before = controller ? controller->GetLocalProcessId() : 0;
  return static_cast<int>(
      std::count(all.begin(), all.begin() + before, static_cast<vtkTypeUInt64>(machine)));
}

int LocalProcesses(vtkMultiProcessController* controller)
{
  const std::uint64_t machine = MachineKey();
  const std::vector<vtkTypeUInt64> all = Gather(controller, machine);
  return static_cast<int>(std::count(all.begin(), all.end(), static_cast<vtkTypeUInt64>(machine)));
}

} // namespace inr
