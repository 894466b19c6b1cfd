// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/LineErrors.h"

#include "Core/Inference/KernelTable.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace inr {

namespace {

constexpr int Ways[13][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {-1, 1, 0},
                             {1, 0, 1},  {-1, 0, 1}, {0, 1, 1},  {0, -1, 1}, {1, 1, 1},
                             {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};

int LastAxis(const int (&way)[3]) { return way[2] != 0 ? 2 : way[1] != 0 ? 1 : 0; }

/// A number for each line that passes a slice, with room around: lines come from up to Margin rows
/// and columns further. All rows make one array, which is what the kernels make vectors of.
class Slice
{
public:
  static constexpr std::int64_t Margin = 4;

  Slice(std::int64_t across, std::int64_t down)
      : Pitch(across + Margin), Count(this->Pitch * down),
        Numbers(static_cast<std::size_t>(this->Count + 2 * Margin * this->Pitch + 2 * Margin), 0.0f)
  {}
  float* begin() { return &this->Numbers[static_cast<std::size_t>(Margin * this->Pitch + Margin)]; }
  float* row(std::int64_t number) { return this->begin() + number * this->Pitch; }
  std::int64_t pitch() const { return this->Pitch; }
  std::int64_t count() const { return this->Count; }
  float largest() const { return *std::max_element(this->Numbers.begin(), this->Numbers.end()); }

private:
  std::int64_t Pitch;
  std::int64_t Count;
  std::vector<float> Numbers;
};

/// Where samples are.
enum class Phase { OnVoxels, BetweenVoxels };

/// All lines that go the same way, side by side, slice by slice along the last axis that they go
/// along. What a sample is taken for may begin at any slice: samples at slice k go on at k + n, so
/// that of each n slices' sums one belongs to every place where the first may be.
class LineSweep
{
public:
  LineSweep(const ValueBox& fine, const ValueBox& taken, const BoxPart& part, const int (&way)[3],
            int power, Phase phase, const LineKernel& kernel)
      : Kernel(kernel), Fine(fine), Taken(taken), Part(part), Way(way[0], way[1], way[2]),
        Length(glm::length(glm::dvec3(this->Way))), Together(VoxelsTogether(way, power)),
        Place(phase), Main(LastAxis(way)), Inner(this->Main == 0 ? 1 : 0),
        Outer(3 - this->Main - this->Inner), Across(part.size[this->Inner]),
        Down(part.size[this->Outer]), Errors(this->Across, this->Down), Amounts(this->Errors),
        Inside(this->Errors), Sums(this->Errors), Magnitudes(this->Errors), Largest(this->Errors)
  {
    for (std::int64_t row = 0; row < this->Down; ++row) {
      std::fill_n(this->Inside.row(row), this->Across, 1.0f);
    }
  }

  /// Along diagonals, where voxels are further apart, half as many.
  static std::int64_t VoxelsTogether(const int (&way)[3], int power)
  {
    const int axes = std::abs(way[0]) + std::abs(way[1]) + std::abs(way[2]);
    return (std::int64_t{1} << power) / (axes > 1 ? 2 : 1);
  }

  void addTo(LineErrors& errors)
  {
    const State none{this->Sums, this->Sums, this->Sums};
    std::vector<State> states(static_cast<std::size_t>(this->Together) + 1, none);
    for (std::int64_t slice = 0; slice < this->Part.size[this->Main]; ++slice) {
      for (std::int64_t row = 0; row < this->Down; ++row) {
        this->findErrors(slice, row);
      }
      const auto count = static_cast<std::int64_t>(states.size());
      this->add(states[static_cast<std::size_t>((slice + 1) % count)], // of slice - Together
                states[static_cast<std::size_t>(slice % count)]);
    }
    const auto length = static_cast<float>(this->Length);
    errors.sum = std::max(errors.sum, length * this->Sums.largest());
    errors.magnitude = std::max(errors.magnitude, length * this->Magnitudes.largest());
    errors.largest = std::max(errors.largest, this->Largest.largest());
  }

private:
  /// Of lines up to a sample: the largest sums that end there, of errors and of their opposites,
  /// and the sum of all magnitudes.
  struct State
  {
    Slice rise;
    Slice fall;
    Slice magnitude;
  };

  /// Of samples at a row of voxels in a slice, or half-way from there to the next: of all that each
  /// is taken for. None where that is not in the box: at the volume's ends rays have no such
  /// sample.
  void findErrors(std::int64_t slice, std::int64_t row)
  {
    const bool between = this->Place == Phase::BetweenVoxels;
    glm::i64vec3 at = this->Part.first;
    at[this->Main] += slice;
    at[this->Outer] += row;
    const std::int64_t before = between ? this->Together / 2 - 1 : this->Together / 2;
    const std::int64_t behind = this->Together / 2;
    const auto [begin, end] = this->inside(at - before * this->Way, at + behind * this->Way);
    float* errors = this->Errors.row(row);
    float* amounts = this->Amounts.row(row);
    std::fill_n(errors, this->Across, 0.0f);
    std::fill_n(amounts, this->Across, 0.0f);
    if (begin == end) {
      return;
    }
    const std::size_t here = this->Fine.index(at.x, at.y, at.z);
    const std::int64_t step = this->Way.x * this->Fine.stride(0) +
                              this->Way.y * this->Fine.stride(1) +
                              this->Way.z * this->Fine.stride(2);
    const LineSamples samples{&this->Taken.values[here],
                              &this->Taken.values[here] + (between ? step : 0),
                              &this->Fine.values[here],
                              this->Fine.stride(this->Inner),
                              errors,
                              amounts,
                              this->Largest.row(row)};
    for (std::int64_t k = -before; k <= behind; ++k) {
      const bool isEnd = !between && this->Together > 1 && std::abs(k) == behind;
      this->Kernel.compare(samples, k * step, isEnd ? 0.5f : 1.0f, begin, end);
    }
  }

  /// Which of a row have all that in the box: places from `first` to `last`.
  std::pair<std::int64_t, std::int64_t> inside(const glm::i64vec3& first,
                                               const glm::i64vec3& last) const
  {
    const glm::i64vec3 low = glm::min(first, last);
    const glm::i64vec3 high = glm::max(first, last);
    const glm::i64vec3& size = this->Fine.size;
    if (low[this->Main] < 0 || high[this->Main] >= size[this->Main] || low[this->Outer] < 0 ||
        high[this->Outer] >= size[this->Outer]) {
      return {0, 0};
    }
    const std::int64_t begin = std::clamp<std::int64_t>(-low[this->Inner], 0, this->Across);
    const std::int64_t end =
        std::clamp<std::int64_t>(size[this->Inner] - high[this->Inner], begin, this->Across);
    return {begin, end};
  }

  void add(State& last, State& next)
  {
    const std::int64_t back =
        this->Together * (this->Way[this->Inner] + this->Way[this->Outer] * this->Errors.pitch());
    this->Kernel.add({this->Errors.begin(), this->Amounts.begin(), this->Inside.begin(),
                      last.rise.begin() - back, last.fall.begin() - back,
                      last.magnitude.begin() - back, next.rise.begin(), next.fall.begin(),
                      next.magnitude.begin(), this->Sums.begin(), this->Magnitudes.begin()},
                     this->Errors.count());
  }

  const LineKernel& Kernel;
  const ValueBox& Fine;
  const ValueBox& Taken;
  BoxPart Part;
  glm::i64vec3 Way;
  double Length;         ///< of it, in voxels
  std::int64_t Together; ///< voxels that one sample is taken for
  Phase Place;
  int Main;  ///< axis of the slices
  int Inner; ///< of the rows in them
  int Outer;
  std::int64_t Across;
  std::int64_t Down;
  Slice Errors;     ///< of samples of a slice
  Slice Amounts;    ///< the same of magnitudes
  Slice Inside;     ///< 1 where there are lines, 0 around them
  Slice Sums;       ///< the largest, of lines up to any slice
  Slice Magnitudes; ///< the same
  Slice Largest;
};

} // namespace

const LineKernel& LineKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Lines); }

LineErrors FindLineErrors(const ValueBox& fine, const ValueBox& taken, const BoxPart& part,
                          int power, const LineKernel& kernel, const IsTooLarge& isTooLarge)
{
  LineErrors errors;
  for (const auto& way : Ways) {
    for (const Phase phase : {Phase::OnVoxels, Phase::BetweenVoxels}) {
      if (phase == Phase::BetweenVoxels && LineSweep::VoxelsTogether(way, power) == 1) {
        continue; // they are means of those
      }
      LineSweep(fine, taken, part, way, power, phase, kernel).addTo(errors);
      if (isTooLarge(errors)) {
        return errors;
      }
    }
  }
  return errors;
}

} // namespace inr
