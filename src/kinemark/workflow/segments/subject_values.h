// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of a subject that recordings hold, and units in which they are shown.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::workflow {

/// What 1 in the field's unit is in SI: 0.001 of a length (mm), pi / 180 of an angle (deg), 1 of others.
[[nodiscard]] double per_shown(analysis::SubjectQuantity quantity);
/// "mm", "deg", "kg" or "".
[[nodiscard]] std::string_view shown_unit(analysis::SubjectQuantity quantity);

/// The parameter of a definition that has this name or is called so in files; null: none.
[[nodiscard]] const analysis::SegmentDefinition::Parameter* find_parameter(
    const analysis::SegmentDefinition& definition, const std::string& name);

/// Numbers of the group PROCESSING of a C3D file that are parameters of the definition: lengths in the file's
/// unit, angles in rad, as Vicon writes them.
[[nodiscard]] std::vector<analysis::SubjectValue> subject_values(
    const data::Trial& trial, const analysis::SegmentDefinition& definition);

/// The laboratory measures the offsets of wands: its marker set has a knee alignment device or medial
/// markers. A file's 0 is then none that was measured.
[[nodiscard]] bool measures_offsets(const data::Trial& trial);

/// Values of one source in units that a body can have. Angles of which one is beyond 1.2 rad are degrees;
/// lengths are scaled where a leg is not 0.2 to 1.5 m long but would be in mm, cm or m. A sentence for each.
void mend_units(std::vector<analysis::SubjectValue>& values, const analysis::SegmentDefinition& definition,
                std::vector<std::string>& warnings);

}  // namespace kinemark::workflow
