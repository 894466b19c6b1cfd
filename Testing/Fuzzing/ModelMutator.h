// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <random>

using Random = std::minstd_rand;

inline std::size_t Below(Random& random, std::size_t end) { return end == 0 ? 0 : random() % end; }

/// libFuzzer's own mutator, of bytes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

/// Changes a model file as a LLVMFuzzerCustomMutator does. Mostly as a document: its values, keys
/// and sections, with lengths, checksum and, often, the numbers that must agree put right again,
/// as bytes that change by chance never come past those. Now and then as bytes.
std::size_t MutateModel(std::uint8_t* data, std::size_t size, std::size_t most, unsigned int seed);

/// Makes the blobs as long as the description, the number of parameters and the macro-cells ask
/// for, where that is little.
void RepairSizes(nlohmann::json& root);
/// Sets the checksum where there is one.
void RepairChecksum(nlohmann::json& root);

/// A packed blob's content, changed and packed again; false for other blobs.
bool MutatePacked(std::vector<std::uint8_t>& blob, Random& random);
