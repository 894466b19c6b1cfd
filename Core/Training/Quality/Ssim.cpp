// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Quality/Ssim.h"

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// SSIM of one window (Wang et al., IEEE TIP 2004) for `n` voxels with the given sums, range 1.
double WindowScore(const std::array<double, 6>& sums, double n)
{
  constexpr double c1 = 0.01 * 0.01;
  constexpr double c2 = 0.03 * 0.03;
  const double meanA = sums[0] / n;
  const double meanB = sums[1] / n;
  const double sample = n / (n - 1.0);
  const double varianceA = sample * (sums[2] / n - meanA * meanA);
  const double varianceB = sample * (sums[3] / n - meanB * meanB);
  const double covariance = sample * (sums[4] / n - meanA * meanB);
  return (2.0 * meanA * meanB + c1) * (2.0 * covariance + c2) /
         ((meanA * meanA + meanB * meanB + c1) * (varianceA + varianceB + c2));
}

} // namespace

SliceSsim::SliceSsim(const glm::i64vec3& size, const Arena& arena)
    : Width(size.x), Height(size.y), Threads(arena)
{
  if (HasWindows(size)) {
    const std::int64_t columns = (size.x - Window + 1) * (size.y - Window + 1);
    this->Columns.assign(static_cast<std::size_t>(columns), Sums{});
  }
}

void SliceSsim::addSlice(const double* reference, const double* decoded)
{
  if (this->Columns.empty()) {
    return;
  }
  SumPlane entering(this->Columns.size());
  this->sumWindows(reference, decoded, entering);
  SumPlane& slot = this->Recent[static_cast<std::size_t>(this->Slices % Window)];
  this->slide(entering, this->Slices >= Window ? &slot : nullptr);
  slot = std::move(entering);
  ++this->Slices;
  if (this->Slices >= Window) {
    this->addColumnScores();
  }
}

void SliceSsim::sumWindows(const double* reference, const double* decoded, SumPlane& plane) const
{
  const std::int64_t columns = this->Width - Window + 1;
  const std::int64_t rows = this->Height - Window + 1;
  this->Threads.forEachBlock(rows, 8, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Sums> line(static_cast<std::size_t>(this->Width));
    for (std::int64_t y = begin; y < end; ++y) {
      std::fill(line.begin(), line.end(), Sums{});
      for (std::int64_t k = 0; k < Window * this->Width; ++k) {
        const std::int64_t at = y * this->Width + k;
        const bool finite = std::isfinite(reference[at]);
        const double a = finite ? reference[at] : 0.0;
        const double b = finite ? decoded[at] : 0.0;
        Sums& sums = line[static_cast<std::size_t>(k % this->Width)];
        const Sums terms = {a, b, a * a, b * b, a * b, finite ? 0.0 : 1.0};
        std::transform(sums.begin(), sums.end(), terms.begin(), sums.begin(), std::plus<>());
      }
      for (std::int64_t x = 0; x < columns; ++x) {
        Sums& sums = plane[static_cast<std::size_t>(y * columns + x)];
        for (std::int64_t k = 0; k < Window; ++k) {
          const Sums& terms = line[static_cast<std::size_t>(x + k)];
          std::transform(sums.begin(), sums.end(), terms.begin(), sums.begin(), std::plus<>());
        }
      }
    }
  });
}

void SliceSsim::slide(const SumPlane& entering, const SumPlane* leaving)
{
  const auto columns = static_cast<std::int64_t>(this->Columns.size());
  this->Threads.forEachBlock(columns, 4096, [&](std::int64_t begin, std::int64_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      for (int s = 0; s < SumCount; ++s) {
        this->Columns[k][s] += entering[k][s] - (leaving != nullptr ? (*leaving)[k][s] : 0.0);
      }
    }
  });
}

void SliceSsim::addColumnScores()
{
  constexpr std::int64_t block = 4096;
  constexpr double voxels = Window * Window * Window;
  const auto columns = static_cast<std::int64_t>(this->Columns.size());
  const auto blocks = static_cast<std::size_t>((columns + block - 1) / block);
  std::vector<double> totals(blocks);
  std::vector<std::int64_t> counts(blocks);
  this->Threads.forEachBlock(columns, block, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const Sums& sums = this->Columns[static_cast<std::size_t>(k)];
      if (sums[5] < 0.5) {
        totals[static_cast<std::size_t>(begin / block)] += WindowScore(sums, voxels);
        ++counts[static_cast<std::size_t>(begin / block)];
      }
    }
  });
  for (std::size_t b = 0; b < blocks; ++b) {
    this->Total += totals[b];
    this->Windows += counts[b];
  }
}

} // namespace inr
