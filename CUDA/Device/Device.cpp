// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Device.h"

#include "CUDA/Device/Runtime.h"
#include "Core/Error.h"

namespace inr {
namespace cuda {

namespace {

constexpr int Oldest = 75; // the first with the tensor cores' instructions

std::string VersionText(int version)
{
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

std::string RuntimeText()
{
  int driver = 0;
  int runtime = 0;
  INR_CUDA(cudaDriverGetVersion(&driver));
  INR_CUDA(cudaRuntimeGetVersion(&runtime));
  return "CUDA " + VersionText(runtime) + ", driver for " + VersionText(driver);
}

/// Why the driver counts no devices. What the runtime says of a driver that is not there is that it
/// is too old.
std::string WhyNoCount(cudaError_t status)
{
  int driver = 0;
  int runtime = 0;
  if (status == cudaErrorInsufficientDriver && cudaDriverGetVersion(&driver) == cudaSuccess &&
      cudaRuntimeGetVersion(&runtime) == cudaSuccess) {
    return driver == 0 ? "there is no NVIDIA driver"
                       : "the NVIDIA driver is for CUDA " + VersionText(driver) +
                             ", and this build for " + VersionText(runtime) + "; update the driver";
  }
  return std::string(cudaGetErrorString(status)) + " (" + cudaGetErrorName(status) + ")";
}

Device Describe(int ordinal)
{
  cudaDeviceProp properties{};
  INR_CUDA(cudaGetDeviceProperties(&properties, ordinal));
  Device device;
  device.ordinal = ordinal;
  device.name = properties.name;
  device.major = properties.major;
  device.minor = properties.minor;
  device.code = CodeFor(INR_CUDA_TARGETS, 10 * device.major + device.minor);
  device.memory = static_cast<std::int64_t>(properties.totalGlobalMem);
  device.multiprocessors = properties.multiProcessorCount;
  device.sharedPerBlock = static_cast<std::int64_t>(properties.sharedMemPerBlockOptin);
  device.sharedPerMultiprocessor = static_cast<std::int64_t>(properties.sharedMemPerMultiprocessor);
  device.l2Cache = properties.l2CacheSize;
  device.runtime = RuntimeText();
  return device;
}

std::string TextOf(const Device& device)
{
  return device.name + " (compute capability " + std::to_string(device.major) + "." +
         std::to_string(device.minor) + ")";
}

/// Nothing where its kernels run. Asks no context of it: another process may be the one to use it.
std::string WhyNot(const Device& device)
{
  int mode = 0;
  INR_CUDA(cudaDeviceGetAttribute(&mode, cudaDevAttrComputeMode, device.ordinal));
  if (mode == cudaComputeModeProhibited) {
    return TextOf(device) + " is closed to computation";
  }
  const int capability = 10 * device.major + device.minor;
  if (capability < Oldest) {
    return TextOf(device) + " is too old: 7.5 is the least";
  }
  return device.code > 0 ? ""
                         : TextOf(device) + " runs none of this build's kernels, which are for " +
                               INR_CUDA_TARGETS + "; configure with -DINR_CUDA_ARCHITECTURES=all";
}

void AppendReason(Devices& devices, const std::string& reason)
{
  devices.reason += (devices.reason.empty() ? "" : "; ") + reason;
}

/// One that fails is left out, like one without kernels.
void Consider(int ordinal, Devices& devices)
{
  try {
    const Device device = Describe(ordinal);
    const std::string reason = WhyNot(device);
    if (reason.empty()) {
      devices.usable.push_back(device);
    } else {
      AppendReason(devices, reason);
    }
  } catch (const Error& error) {
    AppendReason(devices, error.what());
  }
}

} // namespace

Devices FindDevices()
{
  Devices devices;
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess) {
    cudaGetLastError();
    AppendReason(devices, "no CUDA device: " + WhyNoCount(status));
    return devices;
  }
  for (int ordinal = 0; ordinal < count; ++ordinal) {
    Consider(ordinal, devices);
  }
  if (count == 0) {
    AppendReason(devices, "no CUDA device: the NVIDIA driver reports none");
  }
  return devices;
}

} // namespace cuda
} // namespace inr
