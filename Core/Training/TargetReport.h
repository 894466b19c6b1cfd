// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"

#include <string>

namespace inr {

/// For the user of a model that was measured, how far its PSNR is below the options' target, and
/// why; empty where it is not, but for what an estimate may be off.
std::string ShortOfTarget(const Model& model, const TrainingOptions& options);

} // namespace inr
