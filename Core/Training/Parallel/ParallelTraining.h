// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/Trainer.h"

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

/// The other TrainModel from pieces where each process of a group reads a share of them, about as
/// many as the others, any of which its `reader` must be able to give. options.memoryLimit is for
/// each process; the smallest counts. n processes give the model of one with mini-batches n times
/// as large and the same blocks, the same for a given n with maximumSteps. One thread reads and
/// trains in turns, since neither readers nor groups can be expected to stand two. What has been
/// read for the first time is kept beside the checkpoint, see KeptSurvey. Otherwise as above;
/// throws what a reader throws in all processes.
ModelPointer TrainModel(VolumeReader& reader, const VolumeInfo& info,
                        const TrainingOptions& options, const TrainingGroup& group,
                        const TrainingObserver& observer = {});

} // namespace inr
