// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

#include <glm/vec2.hpp>

#include <optional>
#include <string>

namespace inr {

/// What the caller knows better than the file (upstream's files lack a value range, and those
/// trained out of core lie about their dimensions).
struct ModelOverrides
{
  std::optional<glm::i64vec3> dims;
  std::optional<glm::dvec2> dataRange; ///< low < high
};

/// True when the first bytes look like one of our or upstream's model files: BSON by its size or by
/// its first key, or JSON text by that. Reads at most a few KiB; false for anything unreadable.
bool IsModelFile(const std::string& path);

/// Everything but the parameters and the macro-cells (both empty in the result): what a reader
/// needs before it is asked for data. Validates the whole structure. Throws Error.
Model ReadModelHeader(const std::string& path, const ModelOverrides& overrides = {});

/// The whole model; accepts every variant of upstream's files. Throws Error with the file's name,
/// the reason and, where it applies, the byte.
ModelPointer ReadModel(const std::string& path, const ModelOverrides& overrides = {});

/// Writes `path` through a temporary file beside it and a rename: the file is there whole or not at
/// all. The parameters are stored as `model.storedAs` says; quantised ones make a compact file,
/// which no upstream reads. Returns the file's size in bytes. Throws Error(CannotWrite),
/// Error(TooLarge) for 2 GiB or more or where memory runs out, or Error(InvalidModel) for what
/// could not be read back: wrong counts, values that are not finite or that half precision or their
/// step cannot express.
std::int64_t WriteModel(const Model& model, const std::string& path);

/// Throws what WriteModel would say of the model's description, volume and macro-cells, whatever
/// its parameters are: to be asked before a long training.
void RequireStorable(const Model& model);

/// Size in bytes that WriteModel would produce; needs no parameters in `model`, only its
/// description, macro-cells and metadata. Of a compact file (quantised parameters) it is an upper
/// bound as long as there are no parameters, and takes as long as packing them when there are.
std::int64_t ModelFileSize(const Model& model);

} // namespace inr
