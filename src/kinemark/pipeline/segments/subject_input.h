// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of a subject from what people type and from files of a subject.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/vsk/vsk.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::pipeline {

/// "LLegLength=920" or "LThighRotation=4+-2.5", with its standard deviation: lengths in mm, angles in deg,
/// masses in kg. Code::usage for another form, and for a name that the definition does not have, with the
/// nearest that it has.
[[nodiscard]] Result<analysis::SubjectValue> parse_subject_value(
    const std::string& text, const analysis::SegmentDefinition& definition);

/// Parameters with a value of a Vicon subject.
[[nodiscard]] std::vector<analysis::SubjectValue> subject_values(const io::Vsk& vsk, const std::string& name);

/// Lines "$NAME = VALUE" of a Vicon parameter file (.mp) that are parameters of the definition: mm, rad, kg.
/// Code::bad_input for a text without any.
[[nodiscard]] Result<std::vector<analysis::SubjectValue>> parse_mp(
    std::string_view text, const std::string& name, const analysis::SegmentDefinition& definition);

/// Measures of the subject in a .vsk or an .mp, by its ending.
[[nodiscard]] Result<std::vector<analysis::SubjectValue>> read_subject_file(
    const std::filesystem::path& path, const analysis::SegmentDefinition& definition);

}  // namespace kinemark::pipeline
