// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/CachePrecision.h"

namespace inr {

struct Frame;
struct TransferFunction;
struct VolumeInfo;

/// How a cache must keep voxels for a frame with an error tolerance: in 16 bits where what they
/// round changes no pixel by more than an eighth of it, else, and wherever the frame is drawn as
/// with a tolerance of 0 (LevelChooser::choosesFor), as float32. The bound is the steepest change
/// of a pixel per value, times the largest rounding, along the volume's longest diagonal. Throws
/// Error(InvalidArgument) for colours; see Renderer::setTransferFunction.
CachePrecision PrecisionWithin(const Frame& frame, const TransferFunction& colors,
                               const VolumeInfo& volume, bool rangesHold);

} // namespace inr
