// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkWeakPointer.h>

#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkObject;

/// All algorithms that an algorithm's inputs come from, and the readers that ParaView hides in
/// those of file series.
std::vector<vtkAlgorithm*> UpstreamOf(vtkAlgorithm* algorithm);

/// Of a reader of one file that ParaView hides in one of a series upstream: all files of that. Of
/// any other: none.
std::vector<std::string> SeriesOf(vtkAlgorithm* reader, vtkAlgorithm* consumer);

/// Whether what is upstream is an application's data, which has what it has: a simulation's piece
/// of a grid.
bool ComesFromApplication(vtkAlgorithm* algorithm);

/// Whether an algorithm's first input is there as it would come if it were asked for again.
bool IsUpToDate(vtkAlgorithm* algorithm);

/// Keeps what algorithms and executives upstream report as errors while it lives: many readers say
/// so, and then hand on memory that nobody has written to. Messages are shown as ever.
class UpstreamErrors
{
public:
  explicit UpstreamErrors(vtkAlgorithm* algorithm);
  ~UpstreamErrors();
  UpstreamErrors(const UpstreamErrors&) = delete;
  UpstreamErrors& operator=(const UpstreamErrors&) = delete;

  /// From now on messages wait for check() or show(); without these nobody sees them.
  void hold() { this->Holds = true; }

  /// What comes from now on is none of its business.
  void endWatch();

  bool any() const { return !this->First.empty(); }

  /// Throws inr::Error(CannotRead) with the first of them, if there was one.
  void check() const;

  /// What was held back.
  void show() const;

private:
  void watch(vtkObject* object);

  std::vector<std::pair<vtkWeakPointer<vtkObject>, unsigned long>> Watched;
  std::string First;
  bool Holds = false;
  std::vector<std::string> Held;
};
