// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Readers/Training/ControllerGroup.h"
#include "Readers/Training/ParallelInput.h"
#include "Readers/Training/PipelineReader.h"
#include "Readers/Training/RawFiles.h"
#include "Readers/Training/Upstream.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;

/// What is wrong with the raw files that would have to be read for an algorithm's first input; the
/// same in all processes of a group, all of which have to call this. `mayBeThere`: who has the data
/// in memory does not need the files.
std::string FindFileProblem(vtkAlgorithm* consumer, vtkInformation* input, const StepsToRead& steps,
                            bool mayBeThere, const ControllerGroup& group);

/// How what an algorithm's first input gives comes to a training: as a whole, in a group as a piece
/// for each process, or box by box while it trains.
class ReadingPlan
{
public:
  ReadingPlan() = default;

  /// Asks for the whole input or, in a group, this process' piece of it, or for one voxel where the
  /// rest is going to be read in pieces or not at all; with `mayProbe`, a process alone does so
  /// where that is not known. `memoryLimit`: bytes of this machine. For all processes of a group;
  /// throws inr::Error where others cannot be reached.
  ReadingPlan(vtkAlgorithm* consumer, vtkInformation* input, std::int64_t memoryLimit,
              bool mayProbe, const ControllerGroup& group);

  /// Whether a voxel was asked for that never came, of what might give all of it.
  bool isUnanswered() const { return this->Errors && this->Asks == FirstAsked::VoxelToLearn; }

  const WholeImage& whole() const { return this->Whole; }

  /// After find().
  bool inPieces() const { return this->InPieces; }

  /// What is wrong with a raw file that had to be read; the same in all processes.
  const std::string& problem() const { return this->Problem; }

  /// Why all of too much is read at once, for the user; empty where it is not.
  const std::string& whyWhole() const { return this->WhyWhole; }

  /// What upstream has reported since this was made, and reports as long as that lives.
  std::unique_ptr<UpstreamErrors> takeErrors() { return std::move(this->Errors); }

  using Finder = std::function<TrainingInput(vtkDataObject*)>;

  /// What is to be trained on, of what came or, where a voxel shows that all of it is small enough,
  /// then comes; of what is read in pieces, a voxel of it. Throws inr::Error as `find`, FindPiece,
  /// UpdateInput and `errors` do. For all processes of a group.
  ParallelInput find(vtkDataObject* data, std::unique_ptr<UpstreamErrors> errors,
                     const Finder& find, const ControllerGroup& group);

private:
  /// What is asked for before it is known how the rest comes.
  enum class FirstAsked {
    All,
    VoxelOfTooMuch, ///< by what the source tells, all of it is too large
    VoxelToLearn    ///< that says whether it is
  };

  bool isTooLarge(double bytes, const ControllerGroup& group) const;
  void ask(vtkInformation* input, const ControllerGroup& group) const;
  vtkDataObject* afterProbe(vtkDataObject* data, bool failed, const ControllerGroup& group);

  vtkAlgorithm* Consumer = nullptr;
  double MostBytes = 0; ///< that this process may hold
  WholeImage Whole;
  bool IsHeld = false; ///< what this process would ask for
  bool InParts = true; ///< may be asked for
  FirstAsked Asks = FirstAsked::All;
  bool InPieces = false; ///< after find()
  std::string Problem;
  std::string WhyWhole;
  std::unique_ptr<UpstreamErrors> Errors;
};
