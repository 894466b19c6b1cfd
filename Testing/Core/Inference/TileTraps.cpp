// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Core/Inference/TileTraps.h"

#include "Testing/Core/Inference/TileImitation.h"

#include <cpuid.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ucontext.h>

namespace imitation {

namespace {

struct sigaction Before;
volatile long Done = 0;

/// Registers by their number in instructions.
constexpr int Registers[16] = {REG_RAX, REG_RCX, REG_RDX, REG_RBX, REG_RSP, REG_RBP,
                               REG_RSI, REG_RDI, REG_R8,  REG_R9,  REG_R10, REG_R11,
                               REG_R12, REG_R13, REG_R14, REG_R15};

/// "VEX.128.prefix.0F38.W0 opcode ModRM", as Intel's manual names its parts.
struct Instruction
{
  int prefix; ///< pp: 0 for none, 1 for 66, 2 for F3, 3 for F2
  int opcode;
  int mod, reg, rm; ///< with the bits R and B
  int vvvv;
  const char* base; ///< of a memory operand, or null
  std::int64_t index;
  int length;
};

[[noreturn]] void Refuse(const unsigned char* code, const char* what)
{
  std::fprintf(stderr, "trapped at %02x %02x %02x %02x %02x: %s\n", code[0], code[1], code[2],
               code[3], code[4], what);
  std::abort();
}

std::int64_t Displacement(const unsigned char* from, int bytes)
{
  if (bytes == 1) {
    return static_cast<signed char>(*from);
  }
  std::int32_t value = 0;
  std::memcpy(&value, from, static_cast<std::size_t>(bytes));
  return value;
}

/// The memory operand, whose ModRM byte is code[4].
void DecodeMemory(const unsigned char* code, const greg_t* registers, Instruction& instruction)
{
  const int indexBit = (code[1] & 0x40) == 0 ? 8 : 0;
  const int baseBit = (code[1] & 0x20) == 0 ? 8 : 0;
  const int field = code[4] & 7;
  const unsigned char* next = code + 5;
  std::int64_t address = 0;
  int displacement = instruction.mod == 1 ? 1 : instruction.mod == 2 ? 4 : 0;
  bool fromNext = false;
  if (field == 4) {
    const int scale = *next >> 6;
    const int index = (*next >> 3 & 7) + indexBit;
    const int base = *next & 7;
    ++next;
    instruction.index = index == 4 ? 0 : registers[Registers[index]] << scale;
    if (base == 5 && instruction.mod == 0) {
      displacement = 4;
    } else {
      address = registers[Registers[base + baseBit]];
    }
  } else if (field == 5 && instruction.mod == 0) {
    displacement = 4;
    fromNext = true;
  } else {
    address = registers[Registers[field + baseBit]];
  }
  address += Displacement(next, displacement);
  next += displacement;
  instruction.length = static_cast<int>(next - code);
  address += fromNext ? registers[REG_RIP] + instruction.length : 0;
  instruction.base = reinterpret_cast<const char*>(address); // NOLINT(performance-no-int-to-ptr)
}

Instruction Decode(const unsigned char* code, const greg_t* registers)
{
  const bool isKnown = code[0] == 0xc4 && (code[1] & 0x1f) == 2 && (code[2] & 0x84) == 0;
  if (!isKnown) {
    Refuse(code, "no instruction of tiles");
  }
  Instruction instruction{};
  instruction.prefix = code[2] & 3;
  instruction.vvvv = ~code[2] >> 3 & 15;
  instruction.opcode = code[3];
  instruction.mod = code[4] >> 6;
  instruction.reg = (code[4] >> 3 & 7) + ((code[1] & 0x80) == 0 ? 8 : 0);
  instruction.rm = (code[4] & 7) + ((code[1] & 0x20) == 0 ? 8 : 0);
  instruction.length = 5;
  if (instruction.mod != 3) {
    DecodeMemory(code, registers, instruction);
  }
  return instruction;
}

void Execute(const unsigned char* code, const Instruction& instruction)
{
  const bool inMemory = instruction.base != nullptr;
  const int key = instruction.opcode << 4 | instruction.prefix << 1 | (inMemory ? 1 : 0);
  switch (key) {
  case 0x491: { // LDTILECFG
    inr::TileShapes shapes;
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): the key says that it is in memory
    std::memcpy(&shapes, instruction.base, sizeof(shapes));
    return Configure(shapes);
  }
  case 0x490: // TILERELEASE
    return Release();
  case 0x496: // TILEZERO
    return Zero(instruction.reg);
  case 0x4b7: // TILELOADD
    return Load(instruction.reg, instruction.base, instruction.index);
  case 0x4b5: // TILESTORED
    return Store(instruction.reg, const_cast<char*>(instruction.base), instruction.index);
  case 0x5c4: // TDPBF16PS
    return MultiplyAdd(instruction.reg, instruction.rm, instruction.vvvv);
  default:
    Refuse(code, "an unknown instruction of tiles");
  }
}

void Trap(int, siginfo_t*, void* context)
{
  greg_t* const registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto* const code = reinterpret_cast<const unsigned char*>(registers[REG_RIP]);
  const Instruction instruction = Decode(code, registers);
  try {
    Execute(code, instruction);
  } catch (const TileFault& fault) {
    Refuse(code, fault.what());
  }
  registers[REG_RIP] += instruction.length;
  Done = Done + 1;
}

} // namespace

TileTraps::TileTraps()
{
  struct sigaction action = {};
  action.sa_sigaction = Trap;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGILL, &action, &Before);
}

TileTraps::~TileTraps() { sigaction(SIGILL, &Before, nullptr); }

long TileTraps::count() { return Done; }

bool HasTileInstructions()
{
  unsigned eax = 0;
  unsigned ebx = 0;
  unsigned ecx = 0;
  unsigned edx = 0;
  return __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) != 0 && (edx >> 24 & 1u) != 0;
}

} // namespace imitation
