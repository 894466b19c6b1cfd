// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/TransferFunction.h"

#include <vtkType.h>

class vtkVolumeProperty;

namespace inr {

/// The lowest and the highest of a volume's values; they may be the same.
struct ValueSpan
{
  double low;
  double high;

  bool operator==(const ValueSpan& other) const
  {
    return this->low == other.low && this->high == other.high;
  }
};

/// Samples the colour (RGB or gray) and the scalar opacity function of component 0 into one table
/// over what the union of their node ranges shares with a volume's values, or over all of it where
/// that is nothing; logarithmic when the colour function is, unless opacities of negative values
/// vary. The table has 1,025 to 16,385 entries: as many as the closest pair of nodes asks for, and
/// so that nodes where the functions bend are at entries, or near enough for a step of 8 bits.
/// Where nodes ask for more, up to 64 times as many, entries are means of what is between them.
/// Outside the nodes' range both functions are constant: their end values, nothing when their
/// clamping is off.
TransferFunction BuildTransferFunction(vtkVolumeProperty* property, const ValueSpan& values);

/// The table of the last property seen, rebuilt when one of its two functions or the span
/// changed.
class TransferFunctionCache
{
public:
  const TransferFunction& get(vtkVolumeProperty* property, const ValueSpan& values);

private:
  struct Key
  {
    const void* colour = nullptr;
    const void* opacity = nullptr;
    vtkMTimeType colourTime = 0;
    vtkMTimeType opacityTime = 0;
    ValueSpan values = {0, 0};

    bool operator==(const Key& other) const
    {
      return this->colour == other.colour && this->opacity == other.opacity &&
             this->colourTime == other.colourTime && this->opacityTime == other.opacityTime &&
             this->values == other.values;
    }
  };
  static Key makeKey(vtkVolumeProperty* property, const ValueSpan& values);

  Key Built;
  TransferFunction Table;
};

} // namespace inr
