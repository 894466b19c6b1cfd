// SPDX-License-Identifier: BSD-3-Clause
//
// Every allocation that the readers' own library makes fails in turn: it is a VTK error, and the
// next update is right. What VTK itself asks for is not touched, as it cannot do without.
#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDecode.h"
#include "vtkINRReader.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <execinfo.h>
#include <link.h>
#include <new>

namespace {

/// Where the library's code is.
struct Code
{
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
};

Code Library;
std::atomic<std::int64_t> Left{-1}; ///< allocations until one fails; negative: none does
std::atomic<bool> Failed{false};

int FindLibrary(dl_phdr_info* info, std::size_t, void*)
{
  if (std::strstr(info->dlpi_name, "INRReaders") == nullptr) {
    return 0;
  }
  for (int k = 0; k < info->dlpi_phnum; ++k) {
    const ElfW(Phdr)& part = info->dlpi_phdr[k];
    if (part.p_type == PT_LOAD && (part.p_flags & PF_X) != 0) {
      Library = {info->dlpi_addr + part.p_vaddr, info->dlpi_addr + part.p_vaddr + part.p_memsz};
    }
  }
  return 1;
}

bool IsOurs(const void* place)
{
  const auto at = reinterpret_cast<std::uintptr_t>(place);
  return at >= Library.begin && at < Library.end;
}

/// Whether the library asks, by one of its own functions and for itself: VTK's calls of templates
/// may be answered by the library's copies of them.
bool IsAskedByUs(const void* caller)
{
  constexpr int depth = 8;
  void* frames[depth];
  const int count = backtrace(frames, depth);
  const auto asks = std::find(frames, frames + count, caller);
  return std::distance(asks, frames + count) > 1 && IsOurs(asks[0]) && IsOurs(asks[1]);
}

void* Take(std::size_t bytes, const void* caller)
{
  if (Left > 0 && IsOurs(caller) && IsAskedByUs(caller) && --Left == 0) {
    Failed = true;
    throw std::bad_alloc();
  }
  void* const memory = std::malloc(bytes > 0 ? bytes : 1);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

class WithoutMemory : public testing::Test
{
protected:
  WithoutMemory()
  {
    dl_iterate_phdr(FindLibrary, nullptr);
    void* frame = nullptr;
    backtrace(&frame, 1); // the first one takes memory itself
    this->Path = this->Folder / "model.inr";
    inr::WriteModel(*MakeModel({9, 8, 7}), this->Path);
  }

  /// Sums of what the algorithm gives, -1 for nothing.
  static double sum(vtkImageData* image)
  {
    vtkDataArray* const values = image->GetPointData()->GetScalars();
    double sum = values != nullptr ? 0 : -1;
    for (vtkIdType k = 0; values != nullptr && k < values->GetNumberOfTuples(); ++k) {
      sum += values->GetTuple1(k);
    }
    return sum;
  }

  /// `connect` gives an algorithm its input.
  template <typename Algorithm, typename Connect> void survive(const Connect& connect)
  {
    ASSERT_NE(Library.begin, 0u);
    double right = 0;
    bool failed = true;
    int failures = 0;
    for (std::int64_t nth = 0; failed && !HasFailure(); ++nth) { // the 0th: nothing fails
      vtkNew<Algorithm> algorithm;
      connect(algorithm.Get());
      const MessageCapture messages;
      Failed = false;
      Left = nth > 0 ? nth : -1;
      algorithm->Update();
      Left = -1;
      failed = Failed || nth == 0;
      failures += Failed ? 1 : 0;
      if (Failed) {
        EXPECT_GE(messages.errors().size(), 1u) << nth;
        EXPECT_EQ(algorithm->GetOutput()->GetNumberOfPoints(), 0) << nth;
        connect(algorithm.Get());
        algorithm->Modified();
        algorithm->Update();
      }
      const double found = sum(algorithm->GetOutput());
      right = nth == 0 ? found : right;
      EXPECT_EQ(found, right) << nth;
    }
    EXPECT_GT(failures, 5);
  }

  TemporaryFolder Folder;
  std::string Path;
};

TEST_F(WithoutMemory, TheReaderSaysSo)
{
  this->survive<vtkINRReader>(
      [this](vtkINRReader* reader) { reader->SetFileName(this->Path.c_str()); });
}

TEST_F(WithoutMemory, DecodingSaysSo)
{
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->Path.c_str());
  reader->Update();
  this->survive<vtkINRDecode>(
      [&](vtkINRDecode* filter) { filter->SetInputConnection(reader->GetOutputPort()); });
}

TEST_F(WithoutMemory, LookingAtAFileIsHarmless)
{
  vtkNew<vtkINRReader> reader;
  for (std::int64_t nth = 1; nth < 50; ++nth) {
    Left = nth;
    reader->CanReadFile(this->Path.c_str());
    Left = -1;
  }
  EXPECT_EQ(reader->CanReadFile(this->Path.c_str()), 1);
}

/// Who asks for a value cannot be told otherwise.
TEST_F(WithoutMemory, AnArraySaysSo)
{
  ASSERT_NE(Library.begin, 0u);
  int failures = 0;
  bool failed = true;
  for (std::int64_t nth = 1; failed && !HasFailure(); ++nth) {
    vtkNew<vtkINRReader> reader;
    reader->SetFileName(this->Path.c_str());
    reader->Update();
    vtkDataArray* const values = reader->GetOutput()->GetPointData()->GetScalars();
    const MessageCapture messages;
    Failed = false;
    Left = nth;
    const double first = values->GetTuple1(100);
    Left = -1;
    failed = Failed;
    failures += failed ? 1 : 0;
    EXPECT_EQ(messages.errors().size(), failed ? 1u : 0u) << nth;
    const double second = values->GetTuple1(100); // by now there is memory
    EXPECT_TRUE(failed || first == second) << nth;
    EXPECT_GE(second, values->GetRange()[0]);
    EXPECT_GT(sum(reader->GetOutput()), 0);
  }
  EXPECT_GT(failures, 2);
}

} // namespace

void* operator new(std::size_t bytes) { return Take(bytes, __builtin_return_address(0)); }
void* operator new[](std::size_t bytes) { return Take(bytes, __builtin_return_address(0)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
