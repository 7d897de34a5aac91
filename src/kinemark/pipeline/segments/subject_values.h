// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of a subject from what people type and from files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/vsk/vsk.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::pipeline {

/// What 1 in the field's unit is in SI: 0.001 of a length (mm), pi / 180 of an angle (deg), 1 of others.
[[nodiscard]] double per_shown(analysis::SubjectQuantity quantity);
/// "mm", "deg", "kg" or "".
[[nodiscard]] std::string_view shown_unit(analysis::SubjectQuantity quantity);

/// "LLegLength=920": lengths in mm, angles in deg, masses in kg. Code::usage for another form, and for a name
/// that the definition does not have, with the nearest that it has.
[[nodiscard]] Result<analysis::SubjectValue> parse_subject_value(
    const std::string& text, const analysis::SegmentDefinition& definition);

/// Numbers of the group PROCESSING of a C3D file that are parameters of the definition: lengths in the file's
/// unit, angles in rad, as Vicon writes them.
[[nodiscard]] std::vector<analysis::SubjectValue> subject_values(
    const data::Trial& trial, const analysis::SegmentDefinition& definition);

/// Parameters with a value of a Vicon subject.
[[nodiscard]] std::vector<analysis::SubjectValue> subject_values(const io::Vsk& vsk, const std::string& name);

}  // namespace kinemark::pipeline
