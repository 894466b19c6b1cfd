// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/ModelFile.h"

/// What TrainModel.cpp has written.
inline const inr::ModelPointer& TrainedModel()
{
  static const inr::ModelPointer model = inr::ReadModel(INR_TRAINED_MODEL);
  return model;
}
