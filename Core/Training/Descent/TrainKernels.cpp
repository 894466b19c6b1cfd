// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/KernelTable.h"
#include "Core/Training/Descent/TrainKernel.h"

namespace inr {

const TrainKernel& TrainKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Train); }

} // namespace inr
