// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Runtime/TrainingGroup.h"

#include <vtkType.h>

#include <cstdint>
#include <string>
#include <vector>

class vtkMultiProcessController;

/// The processes of a VTK program that runs in several.
class ControllerGroup : public inr::TrainingGroup
{
public:
  /// Without a controller, or with one of a single process, a group of one.
  explicit ControllerGroup(vtkMultiProcessController* controller);

  int rank() const override;
  int size() const override;
  std::vector<std::string> gather(const std::string& bytes) const override;
  void gatherInto(const char* bytes, std::size_t count, inr::GatheredBytes& all) const override;
  void distribute(const char* bytes, const std::vector<std::size_t>& begins,
                  inr::GatheredBytes& mine) const override;

  /// For this process, so that those on the same machine share its cores; 0 (= all) when alone.
  int threads() const;

  /// Of a limit for a machine the share of each process, where the most are on one; the same in
  /// all.
  std::int64_t memoryShare(std::int64_t limit) const;

  /// What the first of them says that says something; empty where none does.
  std::string firstOf(const std::string& said) const;

private:
  void gatherPiece(const std::string& bytes, vtkIdType begin, const std::vector<vtkIdType>& lengths,
                   std::vector<std::string>& parts) const;

  vtkMultiProcessController* Controller; ///< null = alone
};
