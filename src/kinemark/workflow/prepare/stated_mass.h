// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/trial.h"

namespace kinemark::workflow {

/// Mass of the body as a C3D file states it, kg: PROCESSING:BODYMASS, or WEIGHT or MASS of the group SUBJECT
/// or SUBJECTS. NaN where it states none, and where that is below 1 or above 500.
[[nodiscard]] double stated_mass_kg(const data::Trial& trial);

}  // namespace kinemark::workflow
