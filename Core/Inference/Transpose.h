// SPDX-License-Identifier: BSD-3-Clause
//
// Table entries, and features of samples from one after the other to side by side: of eight in
// registers; see Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Lanes.h"

namespace inr {
namespace INR_ISA {

/// The features of one table entry. (An alias template would silently lose the attribute.)
template <int Features> struct RowOf
{
  typedef float Type __attribute__((vector_size(sizeof(float) * Features)));
};
template <int Features> using Row = typename RowOf<Features>::Type;

/// Eight samples of one feature.
using Octet = Row<8>;

inline Row<4> Join(Row<2> a, Row<2> b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3); }
inline Octet Join(Row<4> a, Row<4> b)
{
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Four by four, in either half of the vectors.
inline void TransposeHalves(const Octet (&in)[4], Octet* out)
{
  const Octet a = __builtin_shufflevector(in[0], in[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Octet b = __builtin_shufflevector(in[0], in[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Octet c = __builtin_shufflevector(in[2], in[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Octet d = __builtin_shufflevector(in[2], in[3], 2, 10, 3, 11, 6, 14, 7, 15);
  out[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13);
  out[1] = __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15);
  out[2] = __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13);
  out[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// The lower and the upper halves of two vectors.
inline Octet LowerHalves(Octet a, Octet b)
{
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
}
inline Octet UpperHalves(Octet a, Octet b)
{
  return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
}

/// out[f] = feature f of eight samples, whose features come in `rows`. Nothing goes through memory:
/// reading a vector soon after its parts were written stalls.
inline void TransposeSamples(const Octet (&rows)[8], Octet* out)
{
  const Octet lower[4] = {LowerHalves(rows[0], rows[4]), LowerHalves(rows[1], rows[5]),
                          LowerHalves(rows[2], rows[6]), LowerHalves(rows[3], rows[7])};
  const Octet upper[4] = {UpperHalves(rows[0], rows[4]), UpperHalves(rows[1], rows[5]),
                          UpperHalves(rows[2], rows[6]), UpperHalves(rows[3], rows[7])};
  TransposeHalves(lower, out);
  TransposeHalves(upper, out + 4);
}

inline void TransposeSamples(const Row<4> (&rows)[8], Octet* out)
{
  const Octet pairs[4] = {Join(rows[0], rows[4]), Join(rows[1], rows[5]), Join(rows[2], rows[6]),
                          Join(rows[3], rows[7])};
  TransposeHalves(pairs, out);
}

inline void TransposeSamples(const Row<2> (&rows)[8], Octet* out)
{
  const Octet lower = Join(Join(rows[0], rows[1]), Join(rows[2], rows[3]));
  const Octet upper = Join(Join(rows[4], rows[5]), Join(rows[6], rows[7]));
  out[0] = __builtin_shufflevector(lower, upper, 0, 2, 4, 6, 8, 10, 12, 14);
  out[1] = __builtin_shufflevector(lower, upper, 1, 3, 5, 7, 9, 11, 13, 15);
}

inline void TransposeSamples(const Row<1> (&rows)[8], Octet* out)
{
  out[0] = Octet{rows[0][0], rows[1][0], rows[2][0], rows[3][0],
                 rows[4][0], rows[5][0], rows[6][0], rows[7][0]};
}

/// out[f * stride + k] = feature f of rows[k].
template <int Features>
inline void StoreColumns(const Row<Features> (&rows)[8], float* out, std::int64_t stride)
{
  Octet columns[Features];
  TransposeSamples(rows, columns);
  for (int f = 0; f < Features; ++f) {
    std::memcpy(out + f * stride, &columns[f], sizeof(Octet));
  }
}
/// Of four, where a vector has no more lanes.
template <int Features>
inline void StoreColumns(const Row<Features> (&rows)[4], float* out, std::int64_t stride)
{
  float lanes[4][Features];
  std::memcpy(lanes, rows, sizeof(lanes));
  for (int f = 0; f < Features; ++f) {
    for (int k = 0; k < 4; ++k) {
      out[f * stride + k] = lanes[k][f];
    }
  }
}

} // namespace INR_ISA
} // namespace inr
