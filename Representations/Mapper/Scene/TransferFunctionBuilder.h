// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/TransferFunction.h"

#include <vtkType.h>

class vtkVolumeProperty;

namespace inr {

/// Samples the colour (RGB or gray) and the scalar opacity function of component 0 into one table
/// over the union of their node ranges; logarithmic when the colour function is, unless opacities
/// of negative values vary. The table has 1,025 to 16,385 entries, as many as the closest pair of
/// nodes asks for; where it asks for more, up to 64 times as many, they are means of what is
/// between them. Outside that range both functions are constant: their end values, nothing when
/// their clamping is off.
TransferFunction BuildTransferFunction(vtkVolumeProperty* property);

/// The table of the last property seen, rebuilt when one of its two functions changed.
class TransferFunctionCache
{
public:
  const TransferFunction& get(vtkVolumeProperty* property);

private:
  struct Key
  {
    const void* colour = nullptr;
    const void* opacity = nullptr;
    vtkMTimeType colourTime = 0;
    vtkMTimeType opacityTime = 0;

    bool operator==(const Key& other) const
    {
      return this->colour == other.colour && this->opacity == other.opacity &&
             this->colourTime == other.colourTime && this->opacityTime == other.opacityTime;
    }
  };
  static Key makeKey(vtkVolumeProperty* property);

  Key Built;
  TransferFunction Table;
};

} // namespace inr
