// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Volume/VolumeReader.h"
#include "Readers/Training/TrainingInput.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkImageData;
class vtkInformation;

/// An image as an algorithm's input tells of it before it is asked for.
struct WholeImage
{
  int extent[6] = {0, -1, 0, -1, 0, -1};
  glm::i64vec3 dims{0};
  bool isInMemory = false; ///< all of it
  double bytes = 0; ///< of all arrays whose type the source tells; of doubles where it tells none

  /// What `part` of it has says how many bytes there are.
  void learnBytes(vtkImageData& part);

  /// Of what is connected to an algorithm. No dims where that is no image.
  static WholeImage Of(vtkInformation* input);

  /// Has the pipeline update all of it, or the first voxel, in this process.
  void ask(vtkInformation* input, bool onlyFirst) const;
};

/// Updates an algorithm's first input from within the algorithm's own request for data, after `ask`
/// has said what is wanted. `afresh`: sources have to read, even what they still have, since others
/// count on it: there are some that work together in several processes. Throws
/// inr::Error(CannotRead) when the pipeline fails.
vtkImageData* UpdateInput(vtkAlgorithm& consumer, const std::function<void(vtkInformation*)>& ask,
                          bool afresh);

/// Has the filters upstream ask for their input again: there are some (ForceTime,
/// TemporalInterpolator) that keep what they got for a time, of whatever extent that was.
void ForgetKept(vtkAlgorithm& consumer);

/// Reads boxes of an algorithm's first input by asking the pipeline for them, from within the
/// algorithm's own request for data.
class PipelineReader : public inr::VolumeReader
{
public:
  /// Finds what is to be trained on in an image, or throws.
  using Finder = std::function<TrainingInput(vtkImageData*)>;

  /// `first`: a voxel of it, as the source gives it. `afresh`: see UpdateInput. Where there are
  /// filters upstream, more is asked for than the boxes, as there are some that look at neighbours
  /// and do not ask for these themselves.
  PipelineReader(vtkAlgorithm& consumer, const WholeImage& whole, vtkImageData& first,
                 Finder finder, bool afresh);

  const glm::i64vec3& dims() const override { return this->Whole.dims; }
  inr::ScalarType type() const override { return this->Type; }
  /// Of all arrays; with a margin, a third more for what is left when that is cut off.
  std::int64_t bytesPerVoxel() const override
  {
    return this->Margin > 0 ? (4 * this->Bytes + 2) / 3 : this->Bytes;
  }
  int margin() const override { return this->Margin; }

  /// Throws inr::Error(CannotRead) when the pipeline fails, or gives another array than at first.
  inr::VolumePiece read(const inr::GridBox& box) override;

private:
  vtkSmartPointer<vtkImageData> request(const inr::GridBox& box) const;

  vtkAlgorithm& Consumer;
  WholeImage Whole;
  bool Afresh;
  int Margin; ///< voxels around a box that are asked for, too
  inr::ScalarType Type;
  std::string ArrayName;
  std::int64_t Bytes; ///< per voxel, of all arrays
  Finder Find;
  TrainingInput Piece; ///< keeps the values alive
};
