// SPDX-License-Identifier: BSD-3-Clause
//
// Matrices in float64, and what Newton and Schulz's rounds make of them.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// Row by row.
struct Matrix
{
  Matrix(int rowCount, int columnCount)
      : rows(rowCount), columns(columnCount), values(static_cast<std::size_t>(rows) * columns)
  {}
  double& operator()(int row, int column)
  {
    return this->values[static_cast<std::size_t>(row) * this->columns + column];
  }
  double operator()(int row, int column) const { return const_cast<Matrix&>(*this)(row, column); }

  int rows, columns;
  std::vector<double> values;
};

inline Matrix Product(const Matrix& a, const Matrix& b)
{
  Matrix product(a.rows, b.columns);
  for (int i = 0; i < a.rows; ++i) {
    for (int j = 0; j < b.columns; ++j) {
      for (int k = 0; k < a.columns; ++k) {
        product(i, j) += a(i, k) * b(k, j);
      }
    }
  }
  return product;
}

inline Matrix Transposed(const Matrix& a)
{
  Matrix transposed(a.columns, a.rows);
  for (int i = 0; i < a.rows; ++i) {
    for (int j = 0; j < a.columns; ++j) {
      transposed(j, i) = a(i, j);
    }
  }
  return transposed;
}

inline double Length(const Matrix& a)
{
  double squares = 0;
  for (const double value : a.values) {
    squares += value * value;
  }
  return std::sqrt(squares);
}

/// x / |x|, then five times a x + b x x^T x + c x x^T x x^T x.
inline Matrix NearlyOrthogonal(Matrix x)
{
  const double length = Length(x);
  for (double& value : x.values) {
    value /= length;
  }
  for (int round = 0; round < 5; ++round) {
    const Matrix square = Product(x, Transposed(x));
    const Matrix cubic = Product(square, x);
    const Matrix quintic = Product(square, cubic);
    for (std::size_t k = 0; k < x.values.size(); ++k) {
      x.values[k] = 3.4445 * x.values[k] - 4.775 * cubic.values[k] + 2.0315 * quintic.values[k];
    }
  }
  return x;
}
