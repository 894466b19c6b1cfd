// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Training/Volume.h"

#include <vtkSmartPointer.h>

class vtkDataArray;
class vtkImageData;

/// An image's scalars as the trainer wants them.
struct TrainingInput
{
  vtkSmartPointer<vtkDataArray> values; ///< keeps `data` alive
  inr::VolumeData data;
  inr::VolumeInfo info;
};

/// The image's geometry, with the origin at the first point of its extent, its time step, if any,
/// and the values of `array`, copied only where they do not lie in memory one after the other.
/// Throws inr::Error(InvalidArgument) that says what is wrong with the array.
TrainingInput MakeTrainingInput(vtkImageData* image, vtkDataArray* array);
