// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {

/// What CPUID answers.
struct CpuidAnswer
{
  std::uint32_t eax, ebx, ecx, edx;
};

/// Whom to ask about tile registers; tests make up what they answer.
struct TileAuthorities
{
  CpuidAnswer (*cpuid)(std::uint32_t leaf, std::uint32_t subleaf);
  /// XCR0: which registers the operating system saves. Asked only where CPUID says that one may.
  std::uint64_t (*savedRegisters)();
  /// Asks the operating system to let this process use them, of which it may have heard before.
  bool (*askPermission)();
};

/// Whether a process may use tile registers for products of bfloat16 numbers: the processor has
/// them (AMX-TILE, AMX-BF16) at the size that our kernels want, the system saves them, and it
/// permits them. It is asked for permission only where the rest is so: from then on, it wants 8 KiB
/// more in every signal stack of the process.
bool MayUseTiles(const TileAuthorities& authorities);

/// The same of this process. No need to ask twice.
bool MayUseTiles();

} // namespace inr
