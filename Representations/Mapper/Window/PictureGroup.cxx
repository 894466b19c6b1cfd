// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/PictureGroup.h"

#include "Core/Error.h"
#include "Readers/Common/Processes.h"

#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>

namespace inr {
namespace {

constexpr vtkIdType Piece = vtkIdType{1} << 26; ///< values at once: MPI counts bytes in 32 bits

} // namespace

PictureGroup::PictureGroup(vtkMultiProcessController* controller, std::vector<int> order)
    : Controller(AreSeveral(controller) ? controller : nullptr), Order(std::move(order))
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
    RequireReached(this->Controller->AllReduce(&said, &found, 1, vtkCommunicator::MAX_OP));
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
    RequireReached(this->Controller->AllReduce(values.data() + begin, reduced.data() + begin,
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

Image PictureGroup::whole(const Image& part) const
{
  Image sum;
  this->together([&] { sum = part; });
  const auto count = static_cast<vtkIdType>(part.pixels.size());
  for (vtkIdType begin = 0; !this->isAlone() && begin < count; begin += Piece) {
    RequireReached(this->Controller->Reduce(part.pixels.data() + begin, sum.pixels.data() + begin,
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
  RequireReached(this->Controller->Broadcast(&count, 1, this->drawer()));
  this->together([&] { numbers.resize(static_cast<std::size_t>(count)); });
  RequireReached(count == 0 ||
                 this->Controller->Broadcast(numbers.data(), count, this->drawer()) != 0);
}

std::vector<unsigned char> PictureGroup::gather(const std::vector<unsigned char>& own) const
{
  std::vector<unsigned char> all;
  this->together([&] { all.resize(own.size() * static_cast<std::size_t>(this->processes())); });
  if (this->isAlone()) {
    return own;
  }
  RequireReached(this->Controller->Gather(own.data(), all.data(),
                                          static_cast<vtkIdType>(own.size()), this->drawer()));
  return all;
}

} // namespace inr
