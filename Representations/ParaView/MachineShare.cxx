// SPDX-License-Identifier: BSD-3-Clause
#include "MachineShare.h"

#include "Core/Cache/CacheOptions.h"
#include "Core/Parallel.h"
#include "Readers/Common/Processes.h"
#include "vtkMultiProcessController.h"
#include "vtkType.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace inr {

namespace {

/// Of all processes, in their order.
std::vector<vtkTypeUInt64> Gather(vtkMultiProcessController* controller, std::uint64_t mine)
{
  const auto own = static_cast<vtkTypeUInt64>(mine);
  std::vector<vtkTypeUInt64> all(1, own);
  if (AreSeveral(controller)) {
    all.resize(static_cast<std::size_t>(controller->GetNumberOfProcesses()));
    controller->AllGather(&own, all.data(), 1);
  }
  return all;
}

/// How many of the first `count` processes have the key.
int CountFirst(const std::vector<vtkTypeUInt64>& keys, std::size_t count, std::uint64_t key)
{
  const auto end = keys.begin() + static_cast<std::ptrdiff_t>(count);
  return static_cast<int>(std::count(keys.begin(), end, static_cast<vtkTypeUInt64>(key)));
}

/// MiB for one of so many processes.
int CacheShare(int processes)
{
  constexpr std::int64_t least = 16; // where they are hundreds
  const std::int64_t share = DefaultCacheBytes(processes) >> 20;
  return processes > 1 ? static_cast<int>(std::max(share, least)) : 0;
}

} // namespace

MachineShare ShareMachine(vtkMultiProcessController* controller)
{
  const std::vector<vtkTypeUInt64> cores = Gather(controller, AvailableCoresKey());
  const std::vector<vtkTypeUInt64> machines = Gather(controller, MachineKey());
  const int sharing = CountFirst(cores, cores.size(), AvailableCoresKey());
  const int before = controller ? controller->GetLocalProcessId() : 0;
  MachineShare share;
  share.threads = std::max(1, AvailableCores() / std::max(1, sharing));
  share.rank = CountFirst(machines, static_cast<std::size_t>(before), MachineKey());
  share.cacheSize = CacheShare(CountFirst(machines, machines.size(), MachineKey()));
  return share;
}

} // namespace inr
