// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace inr {
namespace cuda {

/// A GPU that this build has kernels for.
struct Device
{
  int ordinal = 0;
  std::string name; ///< "NVIDIA A100-SXM4-40GB"
  int major = 0;    ///< of the compute capability
  int minor = 0;
  int code = 0;            ///< what runs there of this build's: see CodeFor
  std::int64_t memory = 0; ///< bytes
  int multiprocessors = 0;
  std::int64_t sharedPerBlock = 0; ///< bytes a block may ask for
  std::int64_t sharedPerMultiprocessor = 0;
  std::int64_t l2Cache = 0; ///< bytes
  std::string runtime;      ///< versions of driver and runtime
};

/// What there is on this machine, and for whatever is not used why not: no driver, no GPU, one that
/// is too old, or a build without CUDA. Never throws for such reasons.
struct Devices
{
  std::vector<Device> usable;
  std::string reason; ///< empty where all can be used

  /// That of the `localRank`-th process on this machine, which take turns; null where there is
  /// none.
  const Device* of(int localRank) const;
};
Devices FindDevices();

/// For which of `targets` ("80-real 90-real 90-virtual", in CMake's words) the code is that runs on
/// a device of a compute capability, 86 for 8.6; 0 where none does. Code for a real one runs on the
/// same generation from there on. Code for a virtual one, which the driver translates, does on all
/// that are no older, where there is no other; of each kind the latest.
int CodeFor(const std::string& targets, int capability);

/// Devices::of what there is. Throws Error(Device) with the reason where there is none.
Device ChooseDevice(int localRank = 0);

} // namespace cuda
} // namespace inr
