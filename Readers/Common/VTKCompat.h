// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkVersionMacros.h>
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 7, 0)
#include <vtkMarchingCellsContourCases.h>
#else
#include <vtkArrayIteratorTemplate.h>
#include <vtkMarchingCubesTriangleCases.h>
#endif

// Every difference between the VTK versions that we build against: 9.1 (plain, Debian 12),
// 9.2.20230111 (in ParaView 5.11) and 9.7.0 (cvista, from PyPI).

/// Where OpenGL's own functions and constants are declared.
#if __has_include(<vtk_glad.h>)
#define INR_VTK_OPENGL_HEADER <vtk_glad.h>
#else
#define INR_VTK_OPENGL_HEADER <vtk_glew.h>
#endif

/// Range computations take a ghost array too.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
#define INR_VTK_GHOST_RANGES
#endif

/// Arrays grow through ReserveTuples instead of Resize, and say Capacity instead of Size.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 7, 0)
#define INR_VTK_RESERVE_TUPLES
#define INR_VTK_ARRAY_CAPACITY Capacity
#else
#define INR_VTK_ARRAY_CAPACITY Size
#endif

/// How many values there is room for.
template <class Array> vtkIdType CapacityOf(const Array& array)
{
#ifdef INR_VTK_RESERVE_TUPLES
  return array.GetCapacity();
#else
  return array.GetSize();
#endif
}

/// Tables, statistics and writers of text go through arrays by iterators; later by array dispatch.
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 7, 0)
#define INR_VTK_ARRAY_ITERATORS
#endif

/// Writers override WriteDataAndReturn instead of WriteData.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 7, 0)
#define INR_VTK_WRITERS_RETURN
#endif

/// Whether somebody wants the algorithm to stop. An executive's abort reaches it through CheckAbort
/// where there is such.
inline bool IsAborted(vtkAlgorithm& algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  return algorithm.CheckAbort() || algorithm.GetAbortExecute() != 0;
#else
  return algorithm.GetAbortExecute() != 0;
#endif
}

/// Marching cubes: the edges that the triangles of a cell end on, three by three, then -1. Bit i of
/// `corners` tells whether corner i is inside; corners and edges are numbered as vtkHexahedron's.
inline const int* ContourEdges(int corners)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 7, 0)
  return vtkMarchingCellsContourCases::GetHexahedronCases()[corners];
#else
  return vtkMarchingCubesTriangleCases::GetCases()[corners].edges;
#endif
}
