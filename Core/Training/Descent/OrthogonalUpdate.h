// SPDX-License-Identifier: BSD-3-Clause
//
// Orthogonalised momentum (NewtonSchulz.h) for a layer of the network; see Inference/Lanes.h for
// what may be in here. Every sum has an order of its own: results are the instruction set's alone.
#pragma once

#include "Core/Inference/Mlp.h"
#include "Core/Training/Descent/NewtonSchulz.h"
#include "Core/Training/Descent/TrainKernel.h"

namespace inr {
namespace INR_ISA {

/// How a layer's matrix lies in the workspace: with its shorter side across, padded with zeros to
/// whole vectors.
struct TallMatrix
{
  TallMatrix(int rows, int columns)
      : transposed(rows < columns), height(transposed ? columns : rows),
        width(transposed ? rows : columns),
        stride((std::int64_t{width} + LaneCount - 1) / LaneCount * LaneCount)
  {}

  /// Of element (row, column) of the layer.
  std::int64_t at(int row, int column) const
  {
    return this->transposed ? column * this->stride + row : row * this->stride + column;
  }
  std::int64_t size() const { return this->height * this->stride; }
  std::int64_t squareSize() const { return this->width * this->stride; }

  bool transposed;
  int height, width;
  std::int64_t stride;
};

inline std::int64_t OrthogonalWorkspace(int rows, int columns)
{
  const TallMatrix shape(rows, columns);
  return 2 * (shape.size() + shape.squareSize()) + CacheLineFloats;
}

/// Enters the gradient into the momentum; to[...] = where the step goes, as far as both of them.
/// False: there is no gradient.
inline bool MoveMomentum(const OrthogonalRun& run, const TallMatrix& shape, float* to)
{
  std::memset(to, 0, static_cast<std::size_t>(shape.size()) * sizeof(float));
  bool any = false;
  for (int row = 0; row < run.rows; ++row) {
    for (int column = 0; column < run.columns; ++column) {
      const std::int64_t k = std::int64_t{row} * run.columns + column;
      any |= run.gradients[k] != 0.0f;
      const float added = (1.0f - run.kept) * run.gradients[k];
      run.momentum[k] = run.kept * run.momentum[k] + added;
      to[shape.at(row, column)] = run.kept * run.momentum[k] + added;
    }
  }
  return any;
}

inline Floats Magnitude(Floats value) { return (Floats)((UInts)value & SpreadInt(0x7fffffffu)); }

/// Divides by the largest element, then by the square root of the sum of squares, so that neither
/// tiny nor huge gradients leave float's range. False: all is zero, and nothing is done.
inline bool Normalise(float* values, std::int64_t count)
{
  UInts bits{};
  Floats largestOf{};
  for (std::int64_t k = 0; k < count; k += LaneCount) {
    const Floats magnitude = Magnitude(Load(values + k));
    bits |= (UInts)magnitude;
    largestOf = Maximum(magnitude, largestOf); // not a NaN, which stays one below
  }
  if (IsZero(bits)) {
    return false;
  }
  float largest = largestOf[0];
  for (int lane = 1; lane < LaneCount; ++lane) {
    largest = largest < largestOf[lane] ? largestOf[lane] : largest;
  }
  Floats squares{};
  for (std::int64_t k = 0; k < count; k += LaneCount) {
    const Floats value = Load(values + k) / Spread(largest);
    const Floats kept = Magnitude(value) < Spread(NewtonSchulzNegligible) ? Floats{} : value;
    squares = MultiplyAdd(kept, kept, squares);
    Store(values + k, kept);
  }
  const Floats scale = Spread(1.0f / __builtin_sqrtf(SumLanes(squares)));
  for (std::int64_t k = 0; k < count; k += LaneCount) {
    Store(values + k, scale * Load(values + k));
  }
  return true;
}

/// out = X (aI + bA + cA^2); `gram` and `polynomial` are for A and for what is in brackets.
inline void NewtonSchulzRound(const TallMatrix& shape, const float* x, float* gram,
                              float* polynomial, float* out)
{
  const std::int64_t stride = shape.stride;
  MultiplyBlock({x, shape.width, shape.height, 1, stride}, x, stride, stride, gram);
  MultiplyBlock({gram, shape.width, shape.width, stride, 1}, gram, stride, stride, polynomial);
  for (std::int64_t k = 0; k < shape.squareSize(); k += LaneCount) {
    const Floats square = Spread(NewtonSchulzC) * Load(polynomial + k);
    Store(polynomial + k, MultiplyAdd(Spread(NewtonSchulzB), Load(gram + k), square));
  }
  for (int k = 0; k < shape.width; ++k) {
    polynomial[k * (stride + 1)] += NewtonSchulzA;
  }
  MultiplyBlock({x, shape.height, shape.width, stride, 1}, polynomial, stride, stride, out);
}

inline void UpdateOrthogonally(const OrthogonalRun& run, float* workspace)
{
  const TallMatrix shape(run.rows, run.columns);
  float* x = AlignToLine(workspace);
  float* next = x + shape.size();
  float* const gram = next + shape.size();
  float* const polynomial = gram + shape.squareSize();
  if (!MoveMomentum(run, shape, x) || !Normalise(x, shape.size())) {
    return;
  }
  for (int round = 0; round < NewtonSchulzRounds; ++round) {
    NewtonSchulzRound(shape, x, gram, polynomial, next);
    float* const last = x;
    x = next;
    next = last;
  }
  for (int row = 0; row < run.rows; ++row) {
    for (int column = 0; column < run.columns; ++column) {
      run.parameters[std::int64_t{row} * run.columns + column] -=
          run.rate * x[shape.at(row, column)];
    }
  }
}

} // namespace INR_ISA
} // namespace inr
