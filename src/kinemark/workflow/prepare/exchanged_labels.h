// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers that carry each other's labels, as edits: so they can be kept in a journal, shown, and refused.
#pragma once

#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/trial.h"

namespace kinemark::workflow {

/// The exchange that undoes a label swap, in the trial's own frame numbers.
[[nodiscard]] data::Edit edit_of(const data::Finding& swap, const data::Trial& trial);

/// The label swaps among findings that are as sure as that.
[[nodiscard]] std::vector<data::Finding> sure_swaps(std::span<const data::Finding> findings,
                                                    double sure = 0.8);

/// Label swaps of a trial, and nothing else. Fails as trajectory::screen().
[[nodiscard]] Result<std::vector<data::Finding>> find_label_swaps(const data::Trial& trial);

/// Undo label swaps: all that is known of the samples goes to the marker that they are of; how they were made
/// says "exchanged with" and whose label they carried. Fails as trajectory::apply_edits(); the trial is then
/// as it was.
[[nodiscard]] Status exchange_back(data::Trial& trial, std::span<const data::Finding> swaps);

}  // namespace kinemark::workflow
