// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Device.h"

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

} // namespace cuda
} // namespace inr
