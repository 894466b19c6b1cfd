// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Training/Checkpoint/CheckpointOptions.h"
#include "Core/Training/Descent/TrainingAccelerator.h"
#include "Core/Training/Volume/Volume.h"
#include "Core/Training/Volume/VolumeReader.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace inr {

/// What to train and when to stop; the first limit reached ends it.
struct TrainingOptions
{
  /// dB, as estimated on random voxels every 200 steps (PsnrEstimate.h says of which), with what
  /// storing the parameters is going to cost: 0.1 dB of a Quantised model, 1 dB where a ratio is
  /// asked for; 0 = off. ShortOfTarget tells what the measured quality lacks.
  double targetPsnr = 0;
  /// Volume bytes / file bytes; 0 = by the volume's size, and where there is a description.
  double targetRatio = 0;
  std::uint64_t maximumSteps = 0; ///< 0 = no limit
  double timeLimit = 300;         ///< seconds of training; measuring comes on top; 0 = no limit
  /// Steps that the learning rate is spread over; 0 = maximumSteps or, without it, 10,000 to a
  /// target or else without end, but what the time limit is seen to allow where that is clearly
  /// less. To repeat a training that the time limit counted for, as its record says.
  std::uint64_t plannedSteps = 0;
  std::uint64_t seed = 1; ///< where all neurons of a layer turn off, the next one, up to 3 times
  int macroCellSize = 0;  ///< voxels, a power of two up to 2^29; 0 = DefaultMacroCellSize
  std::optional<Description> description; ///< empty = ChooseDescription
  /// A model of a similar volume, whose parameters are where the training starts if they mean the
  /// same, that is, if it has the same description, and if they leave less than 0.7 of the squared
  /// error of a constant; null = random ones.
  ModelPointer start;
  /// Quantised costs 0.1 dB at most, as estimated on more random voxels, but more where targetRatio
  /// takes it. Half instead where steps cannot be that fine, too few of these voxels are finite, or
  /// more than 2^27 parameters are so equal that no reader would unpack them, and Float where a
  /// half cannot hold a parameter.
  ParameterType storedAs = ParameterType::Quantised;
  /// Bytes that training from a VolumeReader may take, all in all.
  std::int64_t memoryLimit = std::int64_t{1} << 30;
  /// Of a VolumeReader with more than four times as many voxels, the quality is measured on these.
  std::int64_t measuredVoxels = std::int64_t{1} << 26;
  /// Steps and seconds of a training that goes on from its checkpoint include those before. Who
  /// called TrainModel removes the file when the model is safe; a volume of one value has none.
  CheckpointOptions checkpoint;
  /// Parameters of an accelerator's steps are those of the CPU's but for rounding; checkpoints go
  /// on where they came from. Several processes train without it.
  AccelerationOptions acceleration;
  std::string kernel; ///< for tests; empty = the fastest
  int threads = 0;    ///< 0 = all
};

enum class TrainingPhase { Reading, Training, Measuring };

struct TrainingProgress
{
  TrainingPhase phase = TrainingPhase::Training;
  /// Of the whole, 0 to 1, never falling: of what the limits allow and, to a target, of the planned
  /// steps, of which it may not take all.
  double fraction = 0;
  std::uint64_t steps = 0;
  double psnr = 0;          ///< latest estimate in dB; 0 while there is none
  bool accelerated = false; ///< an accelerator trains
  TrainingPipeline pipeline = TrainingPipeline::HostMemory;
};

/// Called on the thread that trains, after every step, between the blocks of a long one and between
/// those of measuring; not while the volume is searched for its range, the model is set up or a
/// step's result is entered into it. Return false to stop, which throws Error(Cancelled). Where a
/// process alone trains from a VolumeReader, the thread that called reads, another one trains, and
/// the first is told the latest between two readings; what checkpoints and accelerators tell comes
/// on the other.
using TrainingObserver = std::function<bool(const TrainingProgress&)>;

/// A model size for the volume: upstream-readable, about volume bytes / `ratio` when its parameters
/// are stored as said; ratio 0 lets the volume's size decide. The smallest model takes a few KiB,
/// whatever the volume and the ratio. A Quantised one is given 4 bits a parameter; what
/// it takes is known after the training only, which then makes steps coarser if need be.
Description ChooseDescription(const glm::i64vec3& dims, ScalarType type, double ratio,
                              ParameterType storedAs = ParameterType::Half, int macroCellSize = 0);

/// Fits an INR to `volume`; `info` gives geometry, name and type (its low and high are measured).
///
/// Mini-batches of BatchSize StratifiedPositions, trilinear targets, L2 loss; updates as
/// Optimiser.h says. In a cell with a NaN or infinite voxel the target is the nearest voxel's
/// value, and where that one is not finite the position carries no gradient; such voxels are
/// counted and left out of range and quality. A constant volume takes no step and is exact, or, of
/// integers that no double tells apart, the double nearest to them; its largest error is then all
/// that is known of its quality. A start shows in the record's
/// earlierSteps, where it is of use. The result's quality and macro-cells are those of the
/// parameters as they are stored. For a given seed, number of steps, plan and kernel family the
/// result is the same whatever the number of threads. Throws Error(InvalidArgument) for a volume
/// without finite voxels or when no limit is set; before it trains what RequireStorable finds; when
/// the time limit ends the first step; Error(InvalidModel) when the network's output stops being
/// finite.
ModelPointer TrainModel(const VolumeData& volume, const VolumeInfo& info,
                        const TrainingOptions& options, const TrainingObserver& observer = {});

/// The same for a volume that is read in pieces, within `options.memoryLimit`.
///
/// One reading of the whole gives range, ranges of macro-cells and a pool of samples, the same
/// number in every equal part of the volume. While another thread trains, this one reads blocks
/// again in random order and draws their samples anew: not more than three times the volume is read
/// in all and, where there is a time limit without
/// maximumSteps, for not more than half of it. With
/// maximumSteps the result is repeatable, whatever the speed of reading, unless the time limit ends
/// it or seems to allow clearly fewer steps. From its checkpoint a process alone goes on without
/// the first reading, and without what was read again, but for some blocks that show whether the
/// volume is still the same; several read it again. Where there are too many voxels, quality is
/// measured in bars all over the volume, and ranges of macro-cells are those of the data, wider by
/// the largest error that was found; otherwise as above. Throws what `reader` throws, but
/// Error(TooLarge) for its std::bad_alloc, and Error(InvalidArgument) when the limit is too low, a
/// value leaves the range that the first reading found, or the data are seen to have changed since
/// otherwise.
ModelPointer TrainModel(VolumeReader& reader, const VolumeInfo& info,
                        const TrainingOptions& options, const TrainingObserver& observer = {});

} // namespace inr
