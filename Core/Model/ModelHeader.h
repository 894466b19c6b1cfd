// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Document.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Model/ModelFile.h"

#include <cstdint>
#include <optional>

namespace inr {

/// A model without its parameters and ranges, and where those are.
struct ModelHeader
{
  Model model; ///< macroCells has its geometry, but no ranges
  const Blob* parameters = nullptr;
  const Blob* ranges = nullptr; ///< nullptr: the file has no macro-cells
  CellEncoding encoding = CellEncoding::Detect;
  std::optional<std::uint32_t> checksum;
};

/// Understands a document of ours or of upstream, in any of its variants, and checks everything
/// that can be checked without reading blobs, their sizes included. Throws Error; the result points
/// into `document`.
ModelHeader ParseModelHeader(const Document& document, const ModelOverrides& overrides);

} // namespace inr
