// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace inr {

/// The times of a series of files, where each tells its own or NaN: those told, between and beyond
/// them those of the others in equal distances. Empty where none is told or two are the same.
std::vector<double> SeriesTimes(std::vector<double> told);

} // namespace inr
