// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"

#include <functional>
#include <vector>

class vtkMultiProcessController;

namespace inr {

/// Processes that make one picture together, each a part of its pixels, of the whole volume. All of
/// them call the same functions in the same order, and wait for each other. Of a group without
/// others, each function is about this process.
class PictureGroup
{
public:
  PictureGroup() = default;
  /// `order`: of the processes as their windows are composed, the first one on top. That one gets
  /// the picture.
  PictureGroup(vtkMultiProcessController* controller, std::vector<int> order);

  bool isAlone() const { return this->Controller == nullptr; }
  /// Whether this process gets the picture.
  bool draws() const;
  const std::vector<int>& order() const { return this->Order; }
  /// How many they are, and which one this is.
  int processes() const;
  int process() const;

  /// Whether all say so.
  bool all(bool said) const;
  /// The largest of what all say.
  int largest(int said) const;
  /// Whether all say the same.
  bool agree(int said) const { return this->largest(said) == -this->largest(-said); }
  /// Makes a step. Throws what it throws and, where it does so in another process,
  /// Error(Cancelled), in all of them.
  void together(const std::function<void()>& step) const;

  enum class Reduction { Least, Sum };
  /// Makes each of `values`, as many in all processes, the least or the sum of theirs.
  void reduce(std::vector<float>& values, Reduction how) const;
  /// Makes window depths, as many in all processes or empty for none, the nearest of all of them.
  void share(std::vector<float>& depth, std::size_t pixels) const;
  /// What the process that draws gets: its own part of the picture and those of the others. Nobody
  /// else's is of use. What is not in a process' part is 0 there.
  Image whole(const Image& part) const;
  /// Makes `numbers` those of the process that draws.
  void tellAll(std::vector<int>& numbers) const;
  /// What the process that draws gets: the bytes of all, as many each, by process.
  std::vector<unsigned char> gather(const std::vector<unsigned char>& own) const;

private:
  int drawer() const { return this->Order.front(); }

  vtkMultiProcessController* Controller = nullptr;
  std::vector<int> Order{0};
};

} // namespace inr
