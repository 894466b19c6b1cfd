// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

class vtkAlgorithm;

/// The class of a reader upstream that must not be asked for a part of its file, though it says
/// that it gives parts; empty where there is none. VTK's readers of MetaImages, DICOM and TGA write
/// whole files or slices into the memory of the part; its reader of NRRD gives no parts of files
/// that are compressed, and of text the values of other voxels.
std::string FindWholeFileReader(vtkAlgorithm* algorithm);

/// The class of a filter upstream that several processes must not ask for a part of what they need
/// together; empty where there is none. ParaView's ResampleToImage cuts what is asked for into a
/// part for each process, and ends the program where it cannot.
std::string FindCollectiveFilter(vtkAlgorithm* algorithm);
