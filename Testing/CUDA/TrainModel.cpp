// SPDX-License-Identifier: BSD-3-Clause
//
// Trains the model that pictures are drawn of in tests, once per build: each test is a process of
// its own, and under a sanitizer training takes longer than most of them.
//
//     train_cuda_model MODEL.inr
#include "Core/Error.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Core/Training/Fields.h"

#include <cstdio>

int main(int argc, char* argv[])
{
  if (argc != 2) {
    std::fputs("usage: train_cuda_model MODEL.inr\n", stderr);
    return 2;
  }
  try {
    const Field<float> field = WaveField();
    inr::WriteModel(*inr::TrainModel(field.data(), {}, Steps(100)), argv[1]);
  } catch (const inr::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
