// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

namespace inr {

/// A volume on a grid of `factor` (0.25 to 4) times as many voxels per axis, rounded: an axis of
/// N > 1 keeps at least 2 voxels, one of a single voxel that voxel. Each u stays at its place in
/// world space, the unit cube, all voxels with their halves around them, where it is. Voxel i of n
/// sits at u = (i + 0.5)/n, so that the points end half a voxel inside of it, more or less far than
/// the native ones. Throws Error(InvalidArgument) for another factor and for more voxels than a
/// volume can have.
VolumeInfo ScaledVolume(const VolumeInfo& volume, double factor);

/// The same network asked for the values of such a grid; `model` itself where the factor is 1. Of a
/// coarser grid the ranges of the macro-cells hold for samples between the new voxels, too; of a
/// finer one that is only hoped (MacroCells::rangesHold). Throws like ScaledVolume.
ModelPointer ScaledModel(const ModelPointer& model, double factor);

} // namespace inr
