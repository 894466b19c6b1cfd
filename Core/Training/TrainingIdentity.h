// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Quality/PsnrEstimate.h"
#include "Core/Training/Samples/BatchSource.h"
#include "Core/Training/Trainer.h"

namespace inr {

/// Names all that decides which parameters a training comes to: the options; of `model` the
/// description, the volume and, in the record, what the training works with; and of the data also
/// the values at the estimate's voxels. Its texts are ASCII. Empty when the options ask for no
/// checkpoint.
TrainingIdentity IdentityOf(const Model& model, const TrainingOptions& options,
                            const PsnrEstimate& estimate, const BatchSource& batches,
                            int processes);

/// But for what the training computes with.
TrainingIdentity WithoutKernel(TrainingIdentity identity);

/// Whether they are of the same data, drawn from alike: of the same training but for what it
/// computes with.
bool HaveSameSamples(const TrainingIdentity& one, const TrainingIdentity& other);

} // namespace inr
