// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Document.h"
#include "Core/Model/InputFile.h"

namespace inr {

/// Takes a BSON file (https://bsonspec.org) apart without recursion and without reading its blobs.
/// Knows the element types that nlohmann-json writes. Every length must lie within its parent's,
/// and the document must fill the file. Throws Error(Malformed) with the byte.
Document ScanBson(const InputFile& file);

/// The same for a model spelled as JSON text (comments allowed), where a blob is an object with an
/// array `bytes`.
Document ScanJsonText(const InputFile& file);

/// The first key of the BSON root document that starts with these bytes; empty when they cannot be
/// one.
std::string FirstBsonKey(const std::string& start);

} // namespace inr
