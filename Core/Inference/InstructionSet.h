// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace inr {

/// The instruction sets for which kernels are built, plainest first.
enum class InstructionSet { Baseline, Avx2, Avx512 };

/// "baseline", "avx2" or "avx512".
const char* InstructionSetName(InstructionSet set);

/// Whether this build has kernels for `set` and this processor and operating system run them.
bool IsUsable(InstructionSet set);

/// The named one, or the best usable one for an empty name. Throws Error(Unsupported) when the name
/// is unknown or not usable here, which `usable` says; Baseline always is.
InstructionSet ChooseInstructionSet(const std::string& name,
                                    bool (*usable)(InstructionSet) = IsUsable);

} // namespace inr
