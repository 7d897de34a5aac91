// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of a subject from what people type and from files.
#pragma once

#include <filesystem>
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

/// "LLegLength=920" or "LThighRotation=4+-2.5", with its standard deviation: lengths in mm, angles in deg,
/// masses in kg. Code::usage for another form, and for a name that the definition does not have, with the
/// nearest that it has.
[[nodiscard]] Result<analysis::SubjectValue> parse_subject_value(
    const std::string& text, const analysis::SegmentDefinition& definition);

/// Numbers of the group PROCESSING of a C3D file that are parameters of the definition: lengths in the file's
/// unit, angles in rad, as Vicon writes them.
[[nodiscard]] std::vector<analysis::SubjectValue> subject_values(
    const data::Trial& trial, const analysis::SegmentDefinition& definition);

/// Parameters with a value of a Vicon subject.
[[nodiscard]] std::vector<analysis::SubjectValue> subject_values(const io::Vsk& vsk, const std::string& name);

/// Lines "$NAME = VALUE" of a Vicon parameter file (.mp) that are parameters of the definition: mm, rad, kg.
/// Code::bad_input for a text without any.
[[nodiscard]] Result<std::vector<analysis::SubjectValue>> parse_mp(
    std::string_view text, const std::string& name, const analysis::SegmentDefinition& definition);

/// Measures of the subject in a .vsk or an .mp, by its ending.
[[nodiscard]] Result<std::vector<analysis::SubjectValue>> read_subject_file(
    const std::filesystem::path& path, const analysis::SegmentDefinition& definition);

/// Values of one source in units that a body can have. Angles of which one is beyond 1.2 rad are degrees;
/// lengths are scaled where a leg is not 0.2 to 1.5 m long but would be in mm, cm or m. A sentence for each.
void mend_units(std::vector<analysis::SubjectValue>& values, const analysis::SegmentDefinition& definition,
                std::vector<std::string>& warnings);

}  // namespace kinemark::pipeline
