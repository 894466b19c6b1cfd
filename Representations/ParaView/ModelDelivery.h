// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "vtkSmartPointer.h"

class vtkDataObject;
class vtkDoubleArray;
class vtkImageData;
class vtkPolyData;
class vtkUnsignedCharArray;

namespace inr {

/// Takes models from the process that has them to the one that draws, within data that ParaView
/// delivers: the model's file is the one tuple of a point array of bytes, under the name of the
/// array that it stands for, and where the image is that of one of doubles. That is what is left
/// where ParaView puts the data of several processes together, of which a single one may send. Of
/// an image with several models it is the active scalars' or, where these are none, the first
/// one's. Of what has no model, the process that draws learns as much as it needs to say so.
class ModelDelivery
{
public:
  /// Puts the model of `data`, an image, if it has one, into `carrier`, which is empty. Packed once
  /// per model. Throws Error for a model that no file can hold.
  void send(vtkDataObject* data, vtkPolyData* carrier);

  /// An image of the model in `carrier`, over the bounds of the one that was sent with as few
  /// points as can be; one of ordinary arrays where that had no model; null where there was none.
  /// Unpacked once per delivery. Throws Error for bytes that are not a model.
  vtkImageData* receive(vtkPolyData* carrier);
  /// Whether what was received is of a group of data sets.
  bool isOfGroup() const { return this->OfGroup; }

private:
  ModelPointer Packed;
  vtkSmartPointer<vtkUnsignedCharArray> Bytes;
  vtkSmartPointer<vtkDoubleArray> Placement;
  vtkSmartPointer<vtkImageData> Image;
  bool OfGroup = false;
};

} // namespace inr
