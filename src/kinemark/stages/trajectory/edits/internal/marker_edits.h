// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Edits of markers, one function an operation. Each fails with Code::bad_input and the reason, and leaves the
// trial as it was then.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/trajectory/edits/apply_edits.h"
#include "kinemark/stages/trajectory/edits/part_of_trial.h"

namespace kinemark::trajectory::internal {

// Edits of events, one function an operation. Each fails with Code::bad_input and the reason, and leaves the
// trial as it was then. An event is the one of that label and context within half a frame of the time given.

[[nodiscard]] Status mark_event(data::Trial& trial, const data::Edit& edit);
[[nodiscard]] Status move_event(data::Trial& trial, const data::Edit& edit);
[[nodiscard]] Status delete_event(data::Trial& trial, const data::Edit& edit);

/// The frames of an edit; Code::bad_input where one lies outside the recording.
[[nodiscard]] Result<FrameSpan> frames_of(const data::Edit& edit, const data::Trial& trial);

/// Without a range the marker gets the new name, or its samples go to the marker that has it and it is no
/// longer there. With one its samples in these frames go there, to a new marker if need be.
[[nodiscard]] Status relabel(data::Trial& trial, const data::Edit& edit);
[[nodiscard]] Status swap_markers(data::Trial& trial, const data::Edit& edit);
[[nodiscard]] Status cut(data::Trial& trial, const data::Edit& edit);
/// @param notes  gets the gaps that were left open
[[nodiscard]] Status fill(data::Trial& trial, const data::Edit& edit, const EditOptions& options,
                          std::vector<std::string>& notes);
[[nodiscard]] Status unfill(data::Trial& trial, const data::Edit& edit);

}  // namespace kinemark::trajectory::internal
