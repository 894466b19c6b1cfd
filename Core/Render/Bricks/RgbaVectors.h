// SPDX-License-Identifier: BSD-3-Clause
//
// Colours as vectors of four. Only for sources that are built once per instruction set; see
// Core/Inference/Lanes.h.
#pragma once

#include <cstring>

namespace inr {
namespace INR_ISA {

namespace {

typedef float Rgba __attribute__((vector_size(16)));
typedef double ExactRgba __attribute__((vector_size(32)));

Rgba LoadRgba(const float* from)
{
  Rgba value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

ExactRgba LoadExactRgba(const double* from)
{
  ExactRgba value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

} // namespace

} // namespace INR_ISA
} // namespace inr
