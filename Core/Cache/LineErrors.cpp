// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/LineErrors.h"

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

float Larger(float a, float b) { return a > b ? a : b; } // std::max keeps loops from vectorising

int LastAxis(const int (&way)[3]) { return way[2] != 0 ? 2 : way[1] != 0 ? 1 : 0; }

/// A number for each line that passes a slice, with a margin of zeros around: where lines begin.
class Slice
{
public:
  Slice(std::int64_t across, std::int64_t down)
      : Pitch(across + 2), Numbers(static_cast<std::size_t>(this->Pitch * (down + 2)), 0.0f)
  {}
  /// From -1 to as many as there are, inclusive.
  float* row(std::int64_t number)
  {
    return &this->Numbers[static_cast<std::size_t>((number + 1) * this->Pitch + 1)];
  }
  float largest() const { return *std::max_element(this->Numbers.begin(), this->Numbers.end()); }

private:
  std::int64_t Pitch;
  std::vector<float> Numbers;
};

/// All lines that go the same way, side by side, slice by slice along the last axis that they go
/// along.
class LineSweep
{
public:
  LineSweep(const ValueBox& fine, const ValueBox& taken, const BoxPart& part, const int (&way)[3],
            int power)
      : Fine(fine), Taken(taken), Part(part), Way(way[0], way[1], way[2]),
        Length(glm::length(glm::dvec3(this->Way))),
        Together((std::int64_t{1} << power) / (this->Length > 1 ? 2 : 1)), Main(LastAxis(way)),
        Inner(this->Main == 0 ? 1 : 0), Outer(3 - this->Main - this->Inner),
        Across(part.size[this->Inner]), Down(part.size[this->Outer]),
        Errors(static_cast<std::size_t>(this->Across)), Sums(this->Across, this->Down),
        Largest(this->Across, this->Down)
  {}

  void addTo(LineErrors& errors)
  {
    State last(this->Across, this->Down);
    State next = last;
    for (std::int64_t slice = 0; slice < this->Part.size[this->Main]; ++slice) {
      for (std::int64_t row = 0; row < this->Down; ++row) {
        this->findErrors(slice, row);
        this->addErrors(row, last, next);
      }
      std::swap(last, next);
    }
    const auto length = static_cast<float>(this->Length);
    errors.sum = std::max(errors.sum, length * this->Sums.largest());
    errors.magnitude = std::max(errors.magnitude, length * this->Magnitude);
    errors.largest = std::max(errors.largest, this->Largest.largest());
  }

private:
  /// Of lines up to a slice: the largest sums that end there, of errors and of their opposites, and
  /// the sum of all magnitudes.
  struct State
  {
    State(std::int64_t across, std::int64_t down)
        : rise(across, down), fall(across, down), magnitude(across, down)
    {}
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
    this->subtract(own, own, fine, 0, begin);
    this->subtract(first, first + step, fine, begin, end);
    this->subtract(own, own, fine, end, this->Across);
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
                std::int64_t end)
  {
    const std::int64_t stride = this->Fine.stride(this->Inner);
    for (std::int64_t k = begin; k < end; ++k) {
      this->Errors[static_cast<std::size_t>(k)] =
          0.5f * (first[k * stride] + second[k * stride]) - fine[k * stride];
    }
  }

  void addErrors(std::int64_t row, State& last, State& next)
  {
    const std::int64_t from = row - this->Way[this->Outer];
    const std::int64_t back = this->Way[this->Inner];
    const float* lastRise = last.rise.row(from) - back;
    const float* lastFall = last.fall.row(from) - back;
    const float* lastMagnitude = last.magnitude.row(from) - back;
    float* rise = next.rise.row(row);
    float* fall = next.fall.row(row);
    float* magnitude = next.magnitude.row(row);
    float* sum = this->Sums.row(row);
    float* largest = this->Largest.row(row);
    for (std::int64_t k = 0; k < this->Across; ++k) {
      const float error = this->Errors[static_cast<std::size_t>(k)];
      rise[k] = Larger(lastRise[k] + error, 0.0f);
      fall[k] = Larger(lastFall[k] - error, 0.0f);
      magnitude[k] = lastMagnitude[k] + std::abs(error);
      sum[k] = Larger(Larger(rise[k], fall[k]), sum[k]);
      largest[k] = Larger(std::abs(error), largest[k]);
    }
    this->Magnitude = std::max(this->Magnitude, *std::max_element(magnitude, magnitude + Across));
  }

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
  std::vector<float> Errors; ///< of a row
  Slice Sums;                ///< the largest, of lines up to any slice
  Slice Largest;
  float Magnitude = 0;
};

} // namespace

LineErrors FindLineErrors(const ValueBox& fine, const ValueBox& taken, const BoxPart& part,
                          int power)
{
  LineErrors errors;
  for (const auto& way : Ways) {
    LineSweep(fine, taken, part, way, power).addTo(errors);
  }
  return errors;
}

} // namespace inr
