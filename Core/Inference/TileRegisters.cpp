// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/TileRegisters.h"

#include "Core/Inference/TileShapes.h"

#if defined(INR_X86_KERNELS) && defined(__linux__)
#include <cpuid.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace inr {

namespace {

constexpr std::uint32_t FeatureLeaf = 7;
constexpr std::uint32_t PaletteLeaf = 0x1d;
constexpr std::uint32_t MultiplierLeaf = 0x1e;

bool Has(std::uint64_t bits, std::uint64_t wanted) { return (bits & wanted) == wanted; }

bool HasInstructions(const TileAuthorities& authorities)
{
  constexpr std::uint32_t bfloat16 = 1u << 22;
  constexpr std::uint32_t tiles = 1u << 24;
  return authorities.cpuid(0, 0).eax >= MultiplierLeaf &&
         Has(authorities.cpuid(FeatureLeaf, 0).edx, bfloat16 | tiles);
}

/// Of palette 1: eight tiles, rows of 64 bytes, 16 of them, and a multiplier for all of that.
bool HasWholeTiles(const TileAuthorities& authorities)
{
  constexpr std::uint32_t bytesPerRow = TileSize * sizeof(float);
  const CpuidAnswer palette = authorities.cpuid(PaletteLeaf, 1);
  const CpuidAnswer multiplier = authorities.cpuid(MultiplierLeaf, 0);
  return authorities.cpuid(PaletteLeaf, 0).eax >= 1 && palette.ebx >> 16 >= 8 &&
         (palette.ebx & 0xffffu) >= bytesPerRow && (palette.ecx & 0xffffu) >= TileSize &&
         (multiplier.ebx & 0xffu) >= TileSize && (multiplier.ebx >> 8 & 0xffffu) >= bytesPerRow;
}

bool AreSaved(const TileAuthorities& authorities)
{
  constexpr std::uint32_t canBeAsked = 1u << 27; // OSXSAVE
  constexpr std::uint64_t shapesAndData = 3u << 17;
  return Has(authorities.cpuid(1, 0).ecx, canBeAsked) &&
         Has(authorities.savedRegisters(), shapesAndData);
}

#if defined(INR_X86_KERNELS) && defined(__linux__)

CpuidAnswer Cpuid(std::uint32_t leaf, std::uint32_t subleaf)
{
  CpuidAnswer answer{};
  __cpuid_count(leaf, subleaf, answer.eax, answer.ebx, answer.ecx, answer.edx);
  return answer;
}

std::uint64_t SavedRegisters()
{
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return std::uint64_t{high} << 32 | low;
}

/// For all threads, those to come as well. Linux 5.16 and later ask for it; before, it saves no
/// tiles.
bool AskPermission()
{
  constexpr long requestPermission = 0x1023; // ARCH_REQ_XCOMP_PERM
  constexpr long tileData = 18;              // XFEATURE_XTILEDATA
  return syscall(SYS_arch_prctl, requestPermission, tileData) == 0;
}

#endif

} // namespace

bool MayUseTiles(const TileAuthorities& authorities)
{
  return HasInstructions(authorities) && HasWholeTiles(authorities) && AreSaved(authorities) &&
         authorities.askPermission();
}

#if defined(INR_X86_KERNELS) && defined(__linux__)
bool MayUseTiles() { return MayUseTiles({Cpuid, SavedRegisters, AskPermission}); }
#else
bool MayUseTiles() { return false; }
#endif

} // namespace inr
