// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Runtime/NoMemory.h"

namespace inr {

Error NoMemoryToTrain()
{
  return Error(ErrorCode::TooLarge,
               "there is not enough memory to train; choose a smaller model (a higher TargetRatio, "
               "or fewer parameters in ModelConfig), or end other programs");
}

Error NoMemoryBesideSteps()
{
  return Error(
      ErrorCode::TooLarge,
      "there is not enough memory to read the data or to train, pack or measure the model; "
      "choose a smaller model (a higher TargetRatio), a lower MemoryLimit where the data "
      "are read in pieces, or end other programs");
}

} // namespace inr
