// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/io/vsk/vsk.h"

namespace kinemark::pipeline {

/// The segments and joints that a recording of a Vicon subject shows. Segments that are fixed to their parent
/// are one with it; those without a marker in the recording are left out. Two segments with markers have a
/// joint where one hangs on the other and turns about a point (ball, Hardy-Spicer, hinge): not where it is
/// free or slides. Markers are found as read_segments() finds them; `warnings` gets a sentence that names
/// those that the recording lacks. Code::bad_input when several subjects carry a name, or no joint is left;
/// the message does not name the file.
[[nodiscard]] Result<data::SegmentLayout> layout_of(const io::Vsk& vsk,
                                                    const std::vector<std::string>& markers,
                                                    std::vector<std::string>& warnings);

/// Read which markers ride on which segment, TOML:
///   [[segment]]
///   name = "forearm"
///   markers = ["WRA", "WRB", "ELB"]
///   [[joint]]
///   name = "elbow"
///   parent = "upper_arm"
///   child = "forearm"      # parent = "ground": the point of the child that stays in the room
///   [[end]]
///   name = "wrist"
///   segment = "forearm"
///   marker = "WRA"         # of the segment's
/// Markers are names of the recording, exactly or behind a subject's prefix ("Ann:WRA"). Without any
/// [[joint]] the segments are joined in the order given. Code::bad_input with file and place for what does
/// not fit.
[[nodiscard]] Result<data::SegmentLayout> read_segments(const std::filesystem::path& path,
                                                        const std::vector<std::string>& markers);
/// The same from memory; `name` stands for the file.
[[nodiscard]] Result<data::SegmentLayout> parse_segments(std::string_view text, const std::string& name,
                                                         const std::vector<std::string>& markers);

/// The text that parse_segments() reads.
[[nodiscard]] std::string segments_text(const data::SegmentLayout& layout,
                                        const std::vector<std::string>& markers);

}  // namespace kinemark::pipeline
