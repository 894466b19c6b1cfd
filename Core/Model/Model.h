// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/AlignedVector.h"
#include "Core/Model/Description.h"
#include "Core/Model/MacroCells.h"
#include "Core/Model/VolumeInfo.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace inr {

/// Measured against the data when the file was written, over all finite voxels, or over some: of
/// the field's values, as they are drawn. A reader that gives them as the data's type rounds them
/// besides, integers to whole numbers.
struct Quality
{
  double psnr = 0;     ///< dB, peak = high - low; infinity when every voxel is exact
  double ssim = 0;     ///< mean 3D SSIM, 7^3 window; NaN where no window of finite voxels was seen
  double maxError = 0; ///< in data units
  /// Finite voxels that were measured, where these were not all; 0 = all.
  std::uint64_t sampledVoxels = 0;
};

/// Where a training's samples come from.
enum class TrainingPipeline {
  DeviceMemory, ///< the volume, in the memory of an accelerator
  HostMemory,   ///< the volume, in the host's
  Storage       ///< samples of a volume that is read in pieces
};

/// Enough to repeat the training.
struct TrainingRecord
{
  std::uint64_t steps = 0;
  std::uint64_t plannedSteps = 0; ///< that the learning rate was spread over; 0 = not known
  std::uint64_t seed = 0;
  double seconds = 0;          ///< wall time, training only
  std::string kernel;          ///< kernel family ("avx512", ...): same family, same parameters
  std::uint64_t nonFinite = 0; ///< NaN and infinite voxels left out
  /// Where it started from another model's parameters: steps that had gone into those, 0 = not
  /// known.
  std::optional<std::uint64_t> earlierSteps;
  /// Not in the file: what trained ("CPU avx2", "CUDA float32, NVIDIA H200"), and from where.
  std::string backend = {};
  TrainingPipeline pipeline = TrainingPipeline::HostMemory;
  /// Not in the file. Of the seconds since the training began or went on, those in which this
  /// process waited for the gradients of others, and in which they told each other theirs.
  double waitingSeconds = 0;
  double exchangeSeconds = 0;
};

enum class ParameterType {
  Half,
  Float,
  Quantised ///< multiples of `Model::steps`, packed; no upstream reads that
};

/// A trained INR: immutable once it is shared. `parameters` follows Layout(description).
struct Model
{
  Description description;
  AlignedVector<float> parameters;
  ParameterType storedAs = ParameterType::Half; ///< precision of `parameters` in the file
  std::vector<float> steps; ///< of quantised parameters, one for each of their ParameterGroups
  VolumeInfo volume;
  /// Voxels of the volume that it was trained from, where `volume` is said to be another grid of
  /// the same (see ScaledModel, ModelOverrides).
  std::optional<glm::i64vec3> nativeDims;
  MacroCells macroCells;
  std::optional<Quality> quality;
  std::optional<TrainingRecord> training;
};

using ModelPointer = std::shared_ptr<const Model>;

/// How the parameters are laid out. Throws Error(InvalidModel) when their count does not fit the
/// description, or one of them is NaN or infinite.
Layout CheckedLayout(const Model& model);

/// Places along each axis that the field tells apart, between which it is smooth: the points of its
/// finest lattice, or the voxels that it was trained from where those are fewer, as samples between
/// them are linear.
glm::i64vec3 ResolutionOf(const Model& model);

} // namespace inr
