// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Core/Inference/TileImitation.h"

#include <cstdlib>
#include <cstring>
#include <immintrin.h>
#include <string>

namespace imitation {

namespace {

constexpr int TileCount = 8;
constexpr int MostRows = 16;
constexpr int MostBytes = 64;

struct Unit
{
  inr::TileShapes shapes{};
  unsigned char data[TileCount][MostRows][MostBytes] = {};
  int configurations = 0;
  Defect defect = Defect::None;
  bool configured = false;

  int rows(int tile) const { return this->shapes.rows[tile]; }
  int bytes(int tile) const { return this->shapes.bytesPerRow[tile]; }
};

thread_local Unit Tiles;

/// Takes no memory where all is fine: in a signal's handler nothing may.
void Require(bool fine, const char* instruction, const char* what)
{
  if (!fine) {
    throw TileFault(std::string(instruction) + ": " + what);
  }
}

void RequireTile(int tile, const char* instruction)
{
  Require(Tiles.configured, instruction, "no tiles are configured");
  Require(0 <= tile && tile < TileCount, instruction, "there is no such tile");
  Require(Tiles.rows(tile) > 0, instruction, "a tile is not configured");
  Require(Tiles.bytes(tile) % 4 == 0, instruction, "a tile has no whole columns");
}

void RequireShapes(const inr::TileShapes& shapes)
{
  const char* const instruction = "LDTILECFG";
  Require(shapes.palette == 1, instruction, "unknown palette");
  Require(shapes.startRow == 0, instruction, "begins in the midst of a tile");
  for (const unsigned char reserved : shapes.reserved) {
    Require(reserved == 0, instruction, "reserved bytes are not zero");
  }
  for (int tile = 0; tile < 16; ++tile) {
    const int most = tile < TileCount ? 1 : 0;
    Require(shapes.rows[tile] <= most * MostRows, instruction, "too many rows");
    Require(shapes.bytesPerRow[tile] <= most * MostBytes, instruction, "too many bytes in a row");
    Require((shapes.rows[tile] == 0) == (shapes.bytesPerRow[tile] == 0), instruction,
            "rows without bytes, or bytes without rows");
  }
}

/// Rounds to nearest, takes denormal numbers for zero and makes none, and raises no flag, as long
/// as it lives.
class TileArithmetic
{
public:
  TileArithmetic() : Before(_mm_getcsr()) { _mm_setcsr(0x1f80 | 0x8040); }
  ~TileArithmetic() { _mm_setcsr(this->Before); }
  TileArithmetic(const TileArithmetic&) = delete;
  TileArithmetic& operator=(const TileArithmetic&) = delete;

private:
  unsigned Before;
};

struct Pair
{
  float lower;
  float upper;
};

Pair PairIn(int tile, int row, int column)
{
  std::uint32_t bits;
  std::memcpy(&bits, Tiles.data[tile][row] + 4 * column, sizeof(bits));
  const std::uint32_t halves[2] = {bits << 16, bits & 0xffff0000u};
  Pair pair;
  std::memcpy(&pair, halves, sizeof(pair));
  return pair;
}

/// Not moved out of TileArithmetic's scope, as the compiler does not know of it.
__attribute__((noinline, target("fma"))) float FusedMultiplyAdd(float a, float b, float c)
{
  return _mm_cvtss_f32(_mm_fmadd_ss(_mm_set_ss(a), _mm_set_ss(b), _mm_set_ss(c)));
}
__attribute__((noinline)) float Add(float a, float b)
{
  return _mm_cvtss_f32(_mm_add_ss(_mm_set_ss(a), _mm_set_ss(b)));
}

/// Not inlined either: GCC 12 then leaves it out.
__attribute__((noinline)) float LosingDigits(float value)
{
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  bits &= 0xffff0000u;
  std::memcpy(&value, &bits, sizeof(bits));
  return value;
}

float Sum(float before, int left, int right, int row, int column)
{
  const Defect defect = Tiles.defect;
  const int pairs = Tiles.rows(right) - (defect == Defect::LosesLastPair ? 1 : 0);
  Pair sums = {0.0f, 0.0f};
  for (int k = 0; k < pairs; ++k) {
    const Pair a = PairIn(left, row, k);
    const Pair b = PairIn(right, k, defect == Defect::SwapsSamples ? column ^ 1 : column);
    sums.lower = FusedMultiplyAdd(a.lower, b.lower, sums.lower);
    if (defect != Defect::LosesUpperHalves) {
      sums.upper = FusedMultiplyAdd(a.upper, b.upper, sums.upper);
    }
  }
  const float both = Add(sums.lower, sums.upper);
  const float all = defect == Defect::ForgetsSums ? both : Add(before, both);
  return defect == Defect::LosesSmallDigits ? LosingDigits(all) : all;
}

} // namespace

void Configure(const inr::TileShapes& shapes)
{
  RequireShapes(shapes);
  // The processor would not mind, but then somebody has not released them.
  Require(!Tiles.configured, "LDTILECFG", "tiles are configured");
  Tiles.configured = true;
  ++Tiles.configurations;
  Tiles.shapes = shapes;
  std::memset(Tiles.data, 0, sizeof(Tiles.data));
}

void Release()
{
  Tiles.configured = false;
  Tiles.shapes = {};
  std::memset(Tiles.data, 0, sizeof(Tiles.data));
}

void Zero(int tile)
{
  RequireTile(tile, "TILEZERO");
  std::memset(Tiles.data[tile], 0, sizeof(Tiles.data[tile]));
}

void Load(int tile, const void* from, std::int64_t stride)
{
  RequireTile(tile, "TILELOADD");
  std::memset(Tiles.data[tile], 0, sizeof(Tiles.data[tile]));
  for (int row = 0; row < Tiles.rows(tile); ++row) {
    std::memcpy(Tiles.data[tile][row], static_cast<const char*>(from) + row * stride,
                static_cast<std::size_t>(Tiles.bytes(tile)));
  }
}

void Store(int tile, void* to, std::int64_t stride)
{
  RequireTile(tile, "TILESTORED");
  // The processor would not mind, but nobody wants that.
  Require(std::abs(stride) >= Tiles.bytes(tile), "TILESTORED", "rows overlap");
  for (int row = 0; row < Tiles.rows(tile); ++row) {
    std::memcpy(static_cast<char*>(to) + row * stride, Tiles.data[tile][row],
                static_cast<std::size_t>(Tiles.bytes(tile)));
  }
}

void MultiplyAdd(int sums, int left, int right)
{
  const char* const instruction = "TDPBF16PS";
  for (const int tile : {sums, left, right}) {
    RequireTile(tile, instruction);
  }
  Require(sums != left && sums != right && left != right, instruction, "tiles overlap");
  Require(Tiles.rows(sums) == Tiles.rows(left), instruction, "rows of sums do not fit");
  Require(Tiles.bytes(sums) == Tiles.bytes(right), instruction, "columns of sums do not fit");
  Require(Tiles.bytes(left) == 4 * Tiles.rows(right), instruction, "the factors do not fit");
  const TileArithmetic arithmetic;
  const int rows = Tiles.rows(sums) - (Tiles.defect == Defect::LosesLastRow ? 1 : 0);
  for (int row = 0; row < rows; ++row) {
    float values[MostBytes / 4];
    std::memcpy(values, Tiles.data[sums][row], sizeof(values));
    for (int column = 0; column < Tiles.bytes(sums) / 4; ++column) {
      values[column] = Sum(values[column], left, right, row, column);
    }
    std::memcpy(Tiles.data[sums][row], values, sizeof(values));
  }
}

void Have(Defect defect) { Tiles.defect = defect; }
bool IsConfigured() { return Tiles.configured; }
int Configurations() { return Tiles.configurations; }

} // namespace imitation
