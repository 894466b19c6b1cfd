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

/// A number for each line that passes a slice, with room around: lines come from one row and one
/// column further. All rows make one array, which is what the compiler makes vectors of.
class Slice
{
public:
  Slice(std::int64_t across, std::int64_t down)
      : Pitch(across + 2), Count(this->Pitch * down),
        Numbers(static_cast<std::size_t>(this->Count + 2 * this->Pitch + 2), 0.0f)
  {}
  /// The first row, one column before it begins.
  float* begin() { return &this->Numbers[static_cast<std::size_t>(this->Pitch + 1)]; }
  float* row(std::int64_t number) { return this->begin() + number * this->Pitch + 1; }
  std::int64_t pitch() const { return this->Pitch; }
  std::int64_t count() const { return this->Count; }
  float largest() const { return *std::max_element(this->Numbers.begin(), this->Numbers.end()); }

private:
  std::int64_t Pitch;
  std::int64_t Count;
  std::vector<float> Numbers;
};

/// All lines that go the same way, side by side, slice by slice along the last axis that they go
/// along.
class LineSweep
{
public:
  LineSweep(const ValueBox& fine, const ValueBox& taken, const BoxPart& part, const int (&way)[3],
            int power, const LineKernel& kernel)
      : Kernel(kernel), Fine(fine), Taken(taken), Part(part), Way(way[0], way[1], way[2]),
        Length(glm::length(glm::dvec3(this->Way))),
        Together((std::int64_t{1} << power) / (this->Length > 1 ? 2 : 1)), Main(LastAxis(way)),
        Inner(this->Main == 0 ? 1 : 0), Outer(3 - this->Main - this->Inner),
        Across(part.size[this->Inner]), Down(part.size[this->Outer]),
        Errors(this->Across, this->Down), Inside(this->Errors), Sums(this->Errors),
        Magnitudes(this->Errors), Largest(this->Errors)
  {
    for (std::int64_t row = 0; row < this->Down; ++row) {
      std::fill_n(this->Inside.row(row), this->Across, 1.0f);
    }
  }

  void addTo(LineErrors& errors)
  {
    State last{this->Sums, this->Sums, this->Sums};
    State next = last;
    for (std::int64_t slice = 0; slice < this->Part.size[this->Main]; ++slice) {
      for (std::int64_t row = 0; row < this->Down; ++row) {
        this->findErrors(slice, row);
      }
      this->add(last, next);
      std::swap(last, next);
    }
    const auto length = static_cast<float>(this->Length);
    errors.sum = std::max(errors.sum, length * this->Sums.largest());
    errors.magnitude = std::max(errors.magnitude, length * this->Magnitudes.largest());
    errors.largest = std::max(errors.largest, this->Largest.largest());
  }

private:
  /// Of lines up to a slice: the largest sums that end there, of errors and of their opposites, and
  /// the sum of all magnitudes.
  struct State
  {
    Slice rise;
    Slice fall;
    Slice magnitude;
  };

  /// Of a row of voxels in a slice. A sample is in the middle between two of those that it is taken
  /// for; where that is a single one, or the box ends before, it is taken where they are.
  void findErrors(std::int64_t slice, std::int64_t row)
  {
    glm::i64vec3 at = this->Part.first;
    at[this->Main] += slice;
    at[this->Outer] += row;
    const std::int64_t toMiddle = this->Together / 2 - 1 - slice % this->Together;
    const glm::i64vec3 before = at + toMiddle * this->Way;
    const auto [begin, end] =
        this->inside(glm::min(before, before + this->Way), glm::max(before, before + this->Way));
    const std::size_t here = this->Fine.index(at.x, at.y, at.z);
    const float* own = &this->Taken.values[here];
    const float* fine = &this->Fine.values[here];
    const std::int64_t step = this->Way.x * this->Fine.stride(0) +
                              this->Way.y * this->Fine.stride(1) +
                              this->Way.z * this->Fine.stride(2);
    const float* first = own + toMiddle * step;
    float* errors = this->Errors.row(row);
    this->subtract(own, own, fine, 0, begin, errors);
    this->subtract(first, first + step, fine, begin, end, errors);
    this->subtract(own, own, fine, end, this->Across, errors);
  }

  /// Which of a row have such a middle, in the box wherever that is from `low` to `high`.
  std::pair<std::int64_t, std::int64_t> inside(const glm::i64vec3& low,
                                               const glm::i64vec3& high) const
  {
    const glm::i64vec3& size = this->Fine.size;
    if (this->Together == 1 || low[this->Main] < 0 || high[this->Main] >= size[this->Main] ||
        low[this->Outer] < 0 || high[this->Outer] >= size[this->Outer]) {
      return {0, 0};
    }
    const std::int64_t begin = std::clamp<std::int64_t>(-low[this->Inner], 0, this->Across);
    const std::int64_t end =
        std::clamp<std::int64_t>(size[this->Inner] - high[this->Inner], begin, this->Across);
    return {begin, end};
  }

  void subtract(const float* first, const float* second, const float* fine, std::int64_t begin,
                std::int64_t end, float* __restrict errors) const
  {
    const std::int64_t stride = this->Fine.stride(this->Inner);
    if (stride == 1) { // which the compiler has to be told
      for (std::int64_t k = begin; k < end; ++k) {
        errors[k] = 0.5f * (first[k] + second[k]) - fine[k];
      }
      return;
    }
    for (std::int64_t k = begin; k < end; ++k) {
      errors[k] = 0.5f * (first[k * stride] + second[k * stride]) - fine[k * stride];
    }
  }

  void add(State& last, State& next)
  {
    const std::int64_t back =
        this->Way[this->Inner] + this->Way[this->Outer] * this->Errors.pitch();
    this->Kernel.add({this->Errors.begin(), this->Inside.begin(), last.rise.begin() - back,
                      last.fall.begin() - back, last.magnitude.begin() - back, next.rise.begin(),
                      next.fall.begin(), next.magnitude.begin(), this->Sums.begin(),
                      this->Magnitudes.begin(), this->Largest.begin()},
                     this->Errors.count());
  }

  const LineKernel& Kernel;
  const ValueBox& Fine;
  const ValueBox& Taken;
  BoxPart Part;
  glm::i64vec3 Way;
  double Length; ///< of it, in voxels
  /// Voxels that one sample is taken for: along diagonals, where they are further apart, half.
  std::int64_t Together;
  int Main;  ///< axis of the slices
  int Inner; ///< of the rows in them
  int Outer;
  std::int64_t Across;
  std::int64_t Down;
  Slice Errors;
  Slice Inside;     ///< 1 where there are lines, 0 around them
  Slice Sums;       ///< the largest, of lines up to any slice
  Slice Magnitudes; ///< the same
  Slice Largest;
};

} // namespace

const LineKernel& LineKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Lines); }

LineErrors FindLineErrors(const ValueBox& fine, const ValueBox& taken, const BoxPart& part,
                          int power, const LineKernel& kernel)
{
  LineErrors errors;
  for (const auto& way : Ways) {
    LineSweep(fine, taken, part, way, power, kernel).addTo(errors);
  }
  return errors;
}

} // namespace inr
