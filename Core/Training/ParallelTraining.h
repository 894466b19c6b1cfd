// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"
#include "Core/Training/TrainingGroup.h"

namespace inr {

/// The other TrainModel where each process of a group holds a piece of the volume (see VolumePart
/// for what pieces may be): n processes give the model of one with mini-batches n times as large,
/// the same for a given n. `info` says how large the whole volume is, and is the same in all
/// processes, as are the options. When to stop by time is decided by rank 0, who also has the
/// checkpoint; an error or a stop in one process ends the training of all. All get the same model;
/// of its quality, SSIM leaves out windows across pieces.
ModelPointer TrainModel(const VolumePiece& piece, const VolumeInfo& info,
                        const TrainingOptions& options, const TrainingGroup& group,
                        const TrainingObserver& observer = {});

} // namespace inr
