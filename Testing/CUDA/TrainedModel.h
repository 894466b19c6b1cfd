// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/ModelFile.h"

#include <cstdint>

/// What TrainModel.cpp has written.
inline const inr::ModelPointer& TrainedModel()
{
  static const inr::ModelPointer model = inr::ReadModel(INR_TRAINED_MODEL);
  return model;
}

inline std::int64_t ResolutionOf(const inr::Model& model)
{
  return inr::Layout(model.description).finestResolution();
}
