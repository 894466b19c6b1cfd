// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

#include <string>

namespace inr {

/// The model as it would stand in a file, for a process that cannot read the file: WriteModel's
/// bytes, and its errors.
std::string ModelToBytes(const Model& model);

/// The model that such bytes stand for, with the same validation as a file's and ReadModel's
/// errors.
ModelPointer ModelFromBytes(std::string bytes);

} // namespace inr
