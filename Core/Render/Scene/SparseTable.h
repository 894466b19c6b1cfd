// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace inr {

struct Minimum
{
  float operator()(float a, float b) const { return a < b ? a : b; }
};
struct Maximum
{
  float operator()(float a, float b) const { return a > b ? a : b; }
};

/// The least or the largest of any run of values in constant time (Bender and Farach-Colton, "The
/// LCA problem revisited", LATIN 2000, section 3): row k has that of 2^k values from each on.
template <class Choice> class SparseTable
{
public:
  SparseTable() = default;
  explicit SparseTable(std::vector<float> values)
  {
    const std::size_t count = values.size();
    this->Rows.push_back(std::move(values));
    for (std::size_t span = 2; span <= count; span *= 2) {
      const std::vector<float>& half = this->Rows.back();
      std::vector<float> row(count - span + 1);
      for (std::size_t k = 0; k < row.size(); ++k) {
        row[k] = Choice()(half[k], half[k + span / 2]);
      }
      this->Rows.push_back(std::move(row));
    }
  }

  /// Of the values first to last, of which there must be one.
  float over(int first, int last) const
  {
    const int power = 31 - __builtin_clz(static_cast<unsigned>(last - first + 1));
    const std::vector<float>& row = this->Rows[static_cast<std::size_t>(power)];
    return Choice()(row[static_cast<std::size_t>(first)],
                    row[static_cast<std::size_t>(last + 1 - (1 << power))]);
  }
  const std::vector<float>& values() const { return this->Rows.front(); }

private:
  std::vector<std::vector<float>> Rows;
};

} // namespace inr
