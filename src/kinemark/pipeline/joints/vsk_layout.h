// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
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

}  // namespace kinemark::pipeline
