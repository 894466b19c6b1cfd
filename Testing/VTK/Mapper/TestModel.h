// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkImageData;

namespace test {

/// An INR that needs no training: one dense grid level of one feature behind a network that hands
/// it through, so that its value is the trilinear interpolation of a known field. The field, three
/// blobs of different size and value, has no symmetry and is 0 at every face. Anisotropic dims and
/// spacing, an origin off zero; values run from -20 to 180.
inr::ModelPointer MakeModel();

/// The same model behind a rotated direction matrix.
inr::ModelPointer MakeOblique();

/// Writes the model into the test's output folder and returns the path.
std::string Write(const inr::Model& model, const std::string& name);

/// The model's voxels, computed at once, as ordinary float scalars.
vtkSmartPointer<vtkImageData> Decode(const inr::ModelPointer& model);

} // namespace test
