// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

class vtkAlgorithm;

/// The class of a reader among the inputs of an algorithm, and theirs, that must not be asked for a
/// part of its file; empty where there is none. vtkMetaImageReader says that it gives parts, but
/// writes the whole file into the memory of the part.
std::string FindWholeFileReader(vtkAlgorithm* algorithm);
