// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Checkpoint/Checkpoint.h"

#include <cstdint>
#include <string>

namespace inr {

/// What a checkpoint says in front of its arrays, as JSON text.
struct CheckpointHeader
{
  CheckpointHeader(TrainingIdentity identity, const TrainingState& state, std::int64_t surveyBytes,
                   std::int64_t trainingBytes);

  /// Throws Error(Malformed), or Error(InvalidModel) for keys that are missing or wrong.
  explicit CheckpointHeader(const std::string& text);

  std::string text() const; ///< ASCII

  TrainingIdentity identity;
  TrainingState state;
  /// Of the file, for the arrays of the survey, and for those behind them; 0 = it has no survey,
  /// and says neither.
  std::int64_t surveyBytes = 0;
  std::int64_t trainingBytes = 0;
};

} // namespace inr
