// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

class vtkProp3D;
class vtkVolumeMapper;

namespace inr {

/// Why a renderer leaves a volume out without a word, and what to do; empty where it does not: a
/// place that is no number, and colouring by what is no point array of the mapper's input.
std::string WhyBlank(vtkProp3D* volume, vtkVolumeMapper* mapper);

} // namespace inr
