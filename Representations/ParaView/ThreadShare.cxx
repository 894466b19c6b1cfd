// SPDX-License-Identifier: BSD-3-Clause
#include "ThreadShare.h"

#include "Core/Parallel.h"
#include "vtkMultiProcessController.h"
#include "vtkType.h"

#include <algorithm>
#include <vector>

namespace inr {

int ThreadShare(vtkMultiProcessController* controller)
{
  const auto own = static_cast<vtkTypeUInt64>(AvailableCoresKey());
  std::vector<vtkTypeUInt64> all(1, own);
  if (controller && controller->GetNumberOfProcesses() > 1) {
    all.resize(static_cast<std::size_t>(controller->GetNumberOfProcesses()));
    controller->AllGather(&own, all.data(), 1);
  }
  const auto sharing = std::count(all.begin(), all.end(), own);
  return std::max(1, AvailableCores() / std::max(1, static_cast<int>(sharing)));
}

} // namespace inr
