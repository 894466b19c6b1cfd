// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Device.h"
#include "Core/Error.h"

#include <sstream>

namespace inr {
namespace cuda {

bool HasCode(const std::string& targets, int capability)
{
  std::istringstream stream(targets);
  std::string target;
  while (stream >> target) {
    const int built = std::stoi(target);
    const bool real = target.find("-real") != std::string::npos;
    if (built <= capability && (!real || built / 10 == capability / 10)) {
      return true;
    }
  }
  return false;
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
