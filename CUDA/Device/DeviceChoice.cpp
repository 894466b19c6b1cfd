// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Device.h"
#include "Core/Error.h"

#include <algorithm>
#include <sstream>

namespace inr {
namespace cuda {

int CodeFor(const std::string& targets, int capability)
{
  std::istringstream stream(targets);
  std::string target;
  int latestReal = 0;
  int latestVirtual = 0;
  while (stream >> target) {
    const int built = std::stoi(target);
    if (built > capability) {
      continue;
    }
    if (target.find("-real") == std::string::npos) {
      latestVirtual = std::max(latestVirtual, built);
    } else if (built / 10 == capability / 10) {
      latestReal = std::max(latestReal, built);
    }
  }
  return latestReal > 0 ? latestReal : latestVirtual;
}

const Device* Devices::of(int localRank) const
{
  return this->usable.empty()
             ? nullptr
             : &this->usable[static_cast<std::size_t>(localRank) % this->usable.size()];
}

Device ChooseDevice(int localRank)
{
  const Devices devices = FindDevices();
  const Device* const device = devices.of(localRank);
  if (device == nullptr) {
    throw Error(ErrorCode::Device, devices.reason);
  }
  return *device;
}

} // namespace cuda
} // namespace inr
