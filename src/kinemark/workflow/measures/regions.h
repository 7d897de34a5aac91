// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which spans of a recording are measured.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"

namespace kinemark::workflow {

/// The span that an option names: "reach=120-300", frames in the file's own numbers, or "reach=1.2s-3s",
/// seconds on the recording's clock, whose nearest frames are taken. Code::usage, with what was expected.
[[nodiscard]] Result<data::Region> parse_region(const std::string& text, const TimeBase& time);

/// The spans from each event of a label to the next of the same label and context: "Foot Strike Right 1",
/// "Foot Strike Right 2", ... Frames nearest to the events; the last frame of a span is the one before the
/// next begins. Code::bad_input where fewer than two events have the label, with the labels that there are.
[[nodiscard]] Result<std::vector<data::Region>> regions_between(const std::string& label,
                                                                const data::Trial& trial);

}  // namespace kinemark::workflow
