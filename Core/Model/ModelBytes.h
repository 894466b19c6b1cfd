// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

#include <string>

namespace inr {

/// The model as a file, for a process that cannot read the file, and waits: where WriteModel packs
/// parameters, this packs them faster, into up to a tenth more. WriteModel's errors.
std::string ModelToBytes(const Model& model);

/// The model that such bytes stand for, with the same validation as a file's and ReadModel's
/// errors.
ModelPointer ModelFromBytes(std::string bytes);

} // namespace inr
