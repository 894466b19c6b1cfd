// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

class vtkAlgorithm;

/// The class of a reader upstream that must not be asked for a part of its file, though it says
/// that it gives parts; empty where there is none. VTK's readers of MetaImages, DICOM and TGA write
/// whole files or slices into the memory of the part; its reader of NRRD gives no parts of files
/// that are compressed, and of text the values of other voxels.
std::string FindWholeFileReader(vtkAlgorithm* algorithm);
