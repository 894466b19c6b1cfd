// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Readers/Training/ControllerGroup.h"
#include "Readers/Training/PipelineReader.h"
#include "Readers/Training/TrainingInput.h"

#include <functional>
#include <string>

class vtkDataObject;
class vtkInformation;

/// Whether this process' piece of an image, as VTK cuts it, is there before anybody asks for it.
bool IsPieceInMemory(vtkInformation* input, const WholeImage& whole, const ControllerGroup& group);

/// Asks the pipeline for this process' piece of an image, as VTK cuts it for the processes of the
/// group; or, if it must not be asked for parts, for all of it.
void RequestPiece(vtkInformation* input, const WholeImage& whole, bool inParts,
                  const ControllerGroup& group);

/// Throws inr::Error(InvalidArgument) in all processes where one has found an array of another name
/// than the first one has.
void RequireOneArray(const std::string& name, const ControllerGroup& group);

/// What a process trains on: in a group, its piece.
struct ParallelInput
{
  TrainingInput input;   ///< values of the piece; `info` is of the whole
  glm::i64vec3 first{0}; ///< voxel of the whole at which the piece begins

  inr::VolumePiece piece() const { return {this->input.data, this->first}; }
};

/// The piece that came, or is cut out of what came, of which `find` says what is to be trained on;
/// some processes may have none, and need not know of the whole. Throws inr::Error in all processes
/// when it does in one, or when they have different arrays.
ParallelInput FindPiece(vtkDataObject* data, const WholeImage& whole,
                        const std::function<TrainingInput(vtkDataObject*)>& find,
                        const ControllerGroup& group);
