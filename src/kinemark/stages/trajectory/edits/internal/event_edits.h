// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Edits of events, one function an operation. Each fails with Code::bad_input and the reason, and leaves the
// trial as it was then. An event is the one of that label and context within half a frame of the time given.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"

namespace kinemark::trajectory::internal {

[[nodiscard]] Status mark_event(data::Trial& trial, const data::Edit& edit);
[[nodiscard]] Status move_event(data::Trial& trial, const data::Edit& edit);
[[nodiscard]] Status delete_event(data::Trial& trial, const data::Edit& edit);

}  // namespace kinemark::trajectory::internal
