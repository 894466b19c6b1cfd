// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Representations/Mapper/Scene/DrawnGrid.h"

#include <string>

class vtkINRDataArray;
class vtkVolumeMapper;

namespace inr {

/// What a mapper is asked to draw; `array` is null, and `problem` says why, when it is no INR.
struct MapperInput
{
  DrawnGrid grid;
  vtkINRDataArray* array = nullptr;
  std::string problem;
};
MapperInput FindInput(vtkVolumeMapper* mapper);

} // namespace inr
