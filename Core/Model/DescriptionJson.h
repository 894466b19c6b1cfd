// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/BsonObject.h"
#include "Core/Model/Description.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace inr {

/// Reads the `encoding` and `network` sections of a tiny-cuda-nn configuration; names are taken
/// case-insensitively, with upstream's synonyms and defaults. Throws Error(Unsupported) for an
/// encoding or network that is not a grid and an MLP, Error(InvalidModel) for bad values; the
/// message names the key.
Description ParseDescription(const nlohmann::json& model);

/// As above, of what a user wrote (C and C++ comments allowed); Error(Malformed) when it is not
/// JSON. Both sections have to be there, if empty, and an unknown key is refused, with those that
/// are known: a misspelt one must not stand for its default. `loss` and `optimizer`, which such
/// configurations have, too, are ignored.
Description ParseModelConfig(const std::string& text);

/// The same sections as upstream writes and reads them.
BsonObject DescriptionSection(const Description& description);
nlohmann::json DescriptionToJson(const Description& description);

} // namespace inr
