// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/LineErrors.h"

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

/// Ways that go up along z, and those in its slices along y; but for these there is the one along
/// x.
constexpr glm::i64vec3 WaysUpZ[] = {{0, 0, 1}, {0, 1, 1},  {0, -1, 1}, {1, 0, 1},  {-1, 0, 1},
                                    {1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};
constexpr glm::i64vec3 WaysUpY[] = {{0, 1, 0}, {1, 1, 0}, {-1, 1, 0}};

/// Where samples are.
enum class Phase { OnVoxels, BetweenVoxels };

/// Samples of one kind along lines of one way, which go up along the axis of the slices.
struct Sampling
{
  Sampling(const glm::i64vec3& way, int power, Phase phase)
      : way(way), phase(phase), together(std::int64_t{1} << power)
  {
    if (std::abs(way.x) + std::abs(way.y) + std::abs(way.z) > 1) {
      this->together /= 2; // where voxels are further apart
    }
  }
  bool isBetween() const { return this->phase == Phase::BetweenVoxels; }
  /// Voxels behind a sample that it is taken for.
  std::int64_t behind() const { return this->together / 2; }
  std::int64_t before() const { return this->behind() - (this->isBetween() ? 1 : 0); }

  glm::i64vec3 way;
  Phase phase;
  std::int64_t together; ///< voxels that one is taken for
};

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
  void clear() { std::fill(this->Numbers.begin(), this->Numbers.end(), 0.0f); }
  float largest() const { return *std::max_element(this->Numbers.begin(), this->Numbers.end()); }

private:
  std::int64_t Pitch;
  std::int64_t Count;
  std::vector<float> Numbers;
};

/// All lines that go the same way, side by side, slice by slice along y or z. What a sample is
/// taken for may begin at any slice: samples at slice k go on at k + n, so that of each n slices'
/// sums one belongs to every place where the first may be.
class LineSweep
{
public:
  LineSweep(const ValueBox& fine, const ValueBox& taken, const GridBox& part, int axis,
            const LineKernel& kernel)
      : Kernel(kernel), Fine(fine), Taken(taken), Part(part), Main(axis), Outer(3 - axis),
        Across(part.size.x), Down(part.size[this->Outer]), Errors(this->Across, this->Down),
        Amounts(this->Errors), Inside(this->Errors), Sums(this->Errors), Magnitudes(this->Errors),
        Largest(this->Errors), Before{this->Errors, this->Errors, this->Errors}
  {
    for (std::int64_t row = 0; row < this->Down; ++row) {
      std::fill_n(this->Inside.row(row), this->Across, 1.0f);
    }
  }

  void addTo(LineErrors& errors, const Sampling& sampling)
  {
    for (Slice* slice : {&this->Sums, &this->Magnitudes, &this->Largest}) {
      slice->clear();
    }
    const auto count = static_cast<std::size_t>(sampling.together) + 1;
    while (this->States.size() < count) { // what is around the lines stays 0
      this->States.push_back(this->Before);
    }
    for (std::int64_t slice = 0; slice < this->Part.size[this->Main]; ++slice) {
      this->findErrors(sampling, slice);
      const auto now = static_cast<std::size_t>(slice) % count;
      const std::size_t last = (now + 1) % count; // of that many slices before
      this->add(sampling, slice < sampling.together ? this->Before : this->States[last],
                this->States[now]);
    }
    const auto length = static_cast<float>(glm::length(glm::dvec3(sampling.way)));
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

  /// Of samples at the voxels of a slice, or half-way from there to the next: of all that each is
  /// taken for. None where that is not in the box: at the volume's ends rays have no such sample.
  void findErrors(const Sampling& sampling, std::int64_t slice)
  {
    glm::i64vec3 at = this->Part.first;
    at[this->Main] += slice;
    const glm::i64vec3 before = -sampling.before() * sampling.way;
    const glm::i64vec3 behind = sampling.behind() * sampling.way;
    const auto [left, right] = this->inside(0, at.x, this->Across, before.x, behind.x);
    const auto [top, bottom] = this->inside(this->Outer, at[this->Outer], this->Down,
                                            before[this->Outer], behind[this->Outer]);
    const auto [here, there] =
        this->inside(this->Main, at[this->Main], 1, before[this->Main], behind[this->Main]);
    if ((right - left) * (bottom - top) * (there - here) < this->Across * this->Down) {
      this->Errors.clear();
      this->Amounts.clear();
    }
    if (left == right || top == bottom || here == there) {
      return;
    }
    at.x += left;
    at[this->Outer] += top;
    const std::int64_t step = sampling.way.x * this->Fine.stride(0) +
                              sampling.way.y * this->Fine.stride(1) +
                              sampling.way.z * this->Fine.stride(2);
    const float* sample = &this->Taken.values[this->Taken.index(at.x, at.y, at.z)];
    const glm::i64vec3 first = at + before;
    this->Kernel.compare(
        {sample, sample + (sampling.isBetween() ? step : 0),
         &this->Fine.values[this->Fine.index(first.x, first.y, first.z)], step,
         this->Fine.stride(this->Outer), this->Errors.row(top) + left,
         this->Amounts.row(top) + left, this->Largest.row(top) + left, this->Errors.pitch()},
        static_cast<int>(sampling.before() + sampling.behind() + 1), bottom - top, right - left);
  }

  /// Which of `count` places from `first` on along an axis have those between `low` and `high` of
  /// them, or the other way round, in the box.
  std::pair<std::int64_t, std::int64_t> inside(int axis, std::int64_t first, std::int64_t count,
                                               std::int64_t low, std::int64_t high) const
  {
    const std::int64_t begin = std::clamp<std::int64_t>(-std::min(low, high) - first, 0, count);
    const std::int64_t end =
        std::clamp<std::int64_t>(this->Fine.size[axis] - std::max(low, high) - first, begin, count);
    return {begin, end};
  }

  void add(const Sampling& sampling, State& last, State& next)
  {
    const std::int64_t back =
        sampling.together * (sampling.way.x + sampling.way[this->Outer] * this->Errors.pitch());
    this->Kernel.add({this->Errors.begin(), this->Amounts.begin(), this->Inside.begin(),
                      last.rise.begin() - back, last.fall.begin() - back,
                      last.magnitude.begin() - back, next.rise.begin(), next.fall.begin(),
                      next.magnitude.begin(), this->Sums.begin(), this->Magnitudes.begin()},
                     this->Errors.count());
  }

  const LineKernel& Kernel;
  const ValueBox& Fine;
  const ValueBox& Taken;
  GridBox Part;
  int Main;  ///< axis of the slices; rows in them go along x
  int Outer; ///< of the rows
  std::int64_t Across;
  std::int64_t Down;
  Slice Errors;     ///< of samples of a slice
  Slice Amounts;    ///< the same of magnitudes
  Slice Inside;     ///< 1 where there are lines, 0 around them
  Slice Sums;       ///< the largest, of lines up to any slice
  Slice Magnitudes; ///< the same
  Slice Largest;
  State Before; ///< all samples: 0
  std::vector<State> States;
};

/// What samples of a part along x are taken for, with x and y changed about: memory is read in
/// rows.
struct Turned
{
  Turned(const ValueBox& fine, const ValueBox& taken, const GridBox& part, int power)
      : fine(glm::i64vec3(0)), taken(this->fine)
  {
    const std::int64_t reach = (std::int64_t{1} << power) / 2;
    GridBox around = part;
    around.first.x = std::max<std::int64_t>(part.first.x - reach, 0);
    around.size.x = std::min(part.first.x + part.size.x + reach, fine.size.x) - around.first.x;
    this->part = {{0, part.first.x - around.first.x, 0}, {part.size.y, part.size.x, part.size.z}};
    this->fine = turn(fine, around);
    this->taken = turn(taken, around);
  }

  static ValueBox turn(const ValueBox& box, const GridBox& part)
  {
    ValueBox turned({part.size.y, part.size.x, part.size.z});
    for (std::int64_t z = 0; z < part.size.z; ++z) {
      for (std::int64_t y = 0; y < part.size.y; ++y) {
        const float* row = &box.values[box.index(part.first.x, part.first.y + y, part.first.z + z)];
        for (std::int64_t x = 0; x < part.size.x; ++x) {
          turned.values[turned.index(y, x, z)] = row[x];
        }
      }
    }
    return turned;
  }

  ValueBox fine;
  ValueBox taken;
  GridBox part;
};

/// On voxels and between them.
void SweepBoth(LineSweep& sweep, const glm::i64vec3& way, int power, LineErrors& errors)
{
  sweep.addTo(errors, Sampling(way, power, Phase::OnVoxels));
  const Sampling between(way, power, Phase::BetweenVoxels);
  if (between.together > 1) { // or else they are means of those
    sweep.addTo(errors, between);
  }
}

} // namespace

const LineKernel& LineKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Lines); }

LineErrors FindLineErrors(const ValueBox& fine, const ValueBox& taken, const GridBox& part,
                          int power, const LineKernel& kernel, const IsTooLarge& isTooLarge)
{
  LineErrors errors;
  const auto sweepAlong = [&](int axis, const auto& ways) { // false: errors are too large
    LineSweep sweep(fine, taken, part, axis, kernel);
    for (const glm::i64vec3& way : ways) {
      SweepBoth(sweep, way, power, errors);
      if (isTooLarge(errors)) {
        return false;
      }
    }
    return true;
  };
  if (!sweepAlong(2, WaysUpZ) || !sweepAlong(1, WaysUpY)) {
    return errors;
  }
  const Turned turned(fine, taken, part, power);
  LineSweep sweep(turned.fine, turned.taken, turned.part, 1, kernel);
  SweepBoth(sweep, {0, 1, 0}, power, errors);
  return errors;
}

} // namespace inr
