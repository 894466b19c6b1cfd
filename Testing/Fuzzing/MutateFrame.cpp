// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Fuzzing/FuzzScene.h"
#include "Testing/Fuzzing/ModelMutator.h"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned int seed);

/// The scene, or the model behind it.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned int seed)
{
  if (size <= SceneSize) {
    return LLVMFuzzerMutate(data, size, most);
  }
  if (seed % 2 == 0) {
    const std::size_t length = LLVMFuzzerMutate(data, SceneSize, SceneSize);
    std::fill(data + length, data + SceneSize, std::uint8_t{0});
    return size;
  }
  return SceneSize + MutateModel(data + SceneSize, size - SceneSize, most - SceneSize, seed / 2);
}
