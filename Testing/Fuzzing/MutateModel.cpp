// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Fuzzing/ModelMutator.h"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned int seed);

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned int seed)
{
  return MutateModel(data, size, most, seed);
}
