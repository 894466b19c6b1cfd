// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Training/Volume/Volume.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkAbstractArray;
class vtkDataArray;
class vtkDataSetAttributes;
class vtkImageData;

/// An image's scalars as the trainer wants them.
struct TrainingInput
{
  vtkSmartPointer<vtkDataArray> values; ///< keeps `data` alive
  inr::VolumeData data;
  inr::VolumeInfo info;
  bool showsHidden = false; ///< values of hidden points, of a type that has no NaN, are among them
};

/// Is an array of this name (may be null) one that tells where others have no values?
bool IsMask(const char* name);

/// The image's geometry, with the origin at the first point of its extent, its time step, if any,
/// and the `values`, copied only where they do not lie in memory one after the other or some are of
/// points that a filter has hidden (as ResampleToImage does outside of a mesh): NaNs take the place
/// of these.
/// Throws inr::Error(InvalidArgument) that says what is wrong with the array.
TrainingInput MakeTrainingInput(vtkImageData* image, vtkAbstractArray* values);

/// What is saved when nobody chooses: the active scalars or the only array, masks left out; else
/// null.
vtkAbstractArray* DefaultArray(vtkDataSetAttributes& data);

/// For the user: that `chosen` (may be null) is none of the point arrays, and which there are
/// beside masks.
std::string NoSuchArray(vtkImageData& image, const char* chosen);
