// SPDX-License-Identifier: BSD-3-Clause
#include "PictureGroup.h"

#include "Core/Error.h"

#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <utility>

namespace inr {
namespace {

constexpr vtkIdType Piece = vtkIdType{1} << 26; ///< values at once: MPI counts bytes in 32 bits

void RequireSuccess(int succeeded)
{
  if (succeeded == 0) {
    throw Error(ErrorCode::CannotRead, "the other processes cannot be reached");
  }
}

} // namespace

Rows RowsOf(const Frame& frame, const glm::i64vec3& dims)
{
  const glm::dmat4 toClip = glm::inverse(frame.worldToIndex * frame.clipToWorld);
  double low = frame.height;
  double high = 0;
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec4 index(-0.5, -0.5, -0.5, 1.0); // a single voxel is a slab
    for (int axis = 0; axis < 3; ++axis) {
      index[axis] += (corner >> axis & 1) != 0 ? static_cast<double>(dims[axis]) : 0.0;
    }
    const glm::dvec4 clip = toClip * index;
    if (!(clip.w > 0)) { // beside or behind the eye
      return {0, frame.height};
    }
    const double row = 0.5 * (clip.y / clip.w + 1.0) * frame.height;
    low = std::min(low, row);
    high = std::max(high, row);
  }
  const auto within = [&frame](double row) {
    return static_cast<int>(std::clamp(row, 0.0, static_cast<double>(frame.height)));
  };
  return {within(std::floor(low)), within(std::ceil(high))};
}

PictureGroup::PictureGroup(vtkMultiProcessController* controller, std::vector<int> order)
    : Controller(controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr),
      Order(std::move(order))
{}

bool PictureGroup::draws() const
{
  return this->isAlone() || this->Controller->GetLocalProcessId() == this->drawer();
}

int PictureGroup::processes() const
{
  return this->isAlone() ? 1 : this->Controller->GetNumberOfProcesses();
}

int PictureGroup::process() const
{
  return this->isAlone() ? 0 : this->Controller->GetLocalProcessId();
}

bool PictureGroup::all(bool said) const { return this->largest(said ? 0 : 1) == 0; }

int PictureGroup::largest(int said) const
{
  int found = said;
  if (!this->isAlone()) {
    RequireSuccess(this->Controller->AllReduce(&said, &found, 1, vtkCommunicator::MAX_OP));
  }
  return found;
}

void PictureGroup::together(const std::function<void()>& step) const
{
  std::exception_ptr problem;
  try {
    step();
  } catch (...) {
    problem = std::current_exception();
  }
  const bool succeeded = this->all(!problem);
  if (problem) {
    std::rethrow_exception(problem);
  }
  if (!succeeded) {
    throw Error(ErrorCode::Cancelled, "another process could not draw its part of the picture");
  }
}

void PictureGroup::reduce(std::vector<float>& values, Reduction how) const
{
  if (this->isAlone()) {
    return;
  }
  std::vector<float> reduced;
  this->together([&] { reduced.resize(values.size()); });
  const auto count = static_cast<vtkIdType>(values.size());
  const int operation = how == Reduction::Sum ? vtkCommunicator::SUM_OP : vtkCommunicator::MIN_OP;
  for (vtkIdType begin = 0; begin < count; begin += Piece) {
    RequireSuccess(this->Controller->AllReduce(values.data() + begin, reduced.data() + begin,
                                               std::min(Piece, count - begin), operation));
  }
  values.swap(reduced);
}

void PictureGroup::share(std::vector<float>& depth, std::size_t pixels) const
{
  if (this->isAlone() || this->all(depth.empty())) {
    return;
  }
  this->together([&] { depth.resize(pixels, 1.0f); });
  this->reduce(depth, Reduction::Least);
}

void PictureGroup::leaveToOthers(const Rows& seen, const Frame& frame,
                                 std::vector<float>& depth) const
{
  if (this->isAlone()) {
    return;
  }
  const std::int64_t rows = seen.end - seen.first;
  const std::int64_t first = seen.first + rows * this->process() / this->processes();
  const std::int64_t end = seen.first + rows * (this->process() + 1) / this->processes();
  depth.resize(static_cast<std::size_t>(frame.width) * frame.height, 1.0f);
  std::fill(depth.begin(), depth.begin() + first * frame.width, 0.0f);
  std::fill(depth.begin() + end * frame.width, depth.end(), 0.0f);
}

Image PictureGroup::whole(const Image& band) const
{
  Image sum;
  this->together([&] { sum = band; });
  const auto count = static_cast<vtkIdType>(band.pixels.size());
  for (vtkIdType begin = 0; !this->isAlone() && begin < count; begin += Piece) {
    // What is not in a process' band is 0 there.
    RequireSuccess(this->Controller->Reduce(band.pixels.data() + begin, sum.pixels.data() + begin,
                                            std::min(Piece, count - begin), vtkCommunicator::SUM_OP,
                                            this->drawer()));
  }
  return sum;
}

void PictureGroup::tellAll(std::vector<int>& numbers) const
{
  if (this->isAlone()) {
    return;
  }
  int count = this->draws() ? static_cast<int>(numbers.size()) : 0;
  RequireSuccess(this->Controller->Broadcast(&count, 1, this->drawer()));
  this->together([&] { numbers.resize(static_cast<std::size_t>(count)); });
  RequireSuccess(count == 0 ||
                 this->Controller->Broadcast(numbers.data(), count, this->drawer()) != 0);
}

std::vector<unsigned char> PictureGroup::gather(const std::vector<unsigned char>& own) const
{
  std::vector<unsigned char> all;
  this->together([&] { all.resize(own.size() * static_cast<std::size_t>(this->processes())); });
  if (this->isAlone()) {
    return own;
  }
  RequireSuccess(this->Controller->Gather(own.data(), all.data(),
                                          static_cast<vtkIdType>(own.size()), this->drawer()));
  return all;
}

} // namespace inr
