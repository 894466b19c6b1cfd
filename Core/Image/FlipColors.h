// SPDX-License-Identifier: BSD-3-Clause
//
// The colours that FLIP computes with; section numbers are those of the paper that Flip.h names.
#pragma once

#include <glm/vec3.hpp>

namespace inr {

/// Linear light of what a display gets, both in [0, 1] (sRGB, IEC 61966-2-1).
glm::dvec3 LinearOf(const glm::dvec3& display);

/// The opponent space YCxCz, which is linear (section 4.1).
glm::dvec3 OpponentOf(const glm::dvec3& linear);
glm::dvec3 LinearOfOpponent(const glm::dvec3& opponent);

/// CIE L*a*b* with Hunt's adjustment: colours of little light differ less (section 4.1.2).
glm::dvec3 PerceivedColor(const glm::dvec3& linear);

/// The HyAB distance of two of these (section 4.1.3).
double ColorDistance(const glm::dvec3& a, const glm::dvec3& b);

} // namespace inr
