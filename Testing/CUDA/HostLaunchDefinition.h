// SPDX-License-Identifier: BSD-3-Clause
//
// What HostLaunch.h declares; INR_INSTANTIATE(Kernel) makes a kernel one that can be run.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "Testing/CUDA/HostLaunch.h"

#include <cstddef>
#include <cstring>
#include <memory>

template <class Kernel> void HostLaunch::run(const Kernel& kernel, std::int64_t sharedBytes) const
{
  for (int block = 0; block < this->blocks; ++block) {
    struct alignas(16) Line
    {
      unsigned char bytes[16];
    };
    const auto lines = static_cast<std::size_t>((sharedBytes + 15) / 16);
    const std::unique_ptr<Line[]> memory(new Line[lines]);
    std::memset(memory.get(), 0xff, lines * sizeof(Line));
    const int index = this->backward ? this->blocks - 1 - block : block;
    inr::cuda::HostBlock<Kernel::Threads> place(
        index, this->blocks, reinterpret_cast<unsigned char*>(memory.get()), this->backward);
    kernel(place);
  }
}

#define INR_INSTANTIATE(Kernel)                                                                    \
  template void HostLaunch::run<Kernel>(const Kernel&, std::int64_t) const
