// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A person's edits, applied. The recording as it was read stays as it is: what is not wanted any more is left
// out of the list, and the rest is applied again.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"

namespace kinemark::trajectory {

/// Options of apply_edits().
struct EditOptions {
  std::uint64_t seed = 1;  ///< of fills: which artificial gaps are taken
  int threads = 1;         ///< 0: all cores. Any number gives the same bits.
  Progress progress;       ///< edits done of all
};

/// A recording with edits in it, and what they say beside samples.
struct EditedTrial {
  data::Trial trial;                  ///< states and methods tell what became of each sample
  std::vector<data::Region> regions;  ///< in the order in which they were named first
  std::vector<std::string> notes;     ///< what an edit could do in part only, one sentence each
};

/// Apply operations in force, in their order, on what others left. So a list gives the same bits in one call
/// or in several.
///
/// A marker is found by its name, or by the part behind the subject's prefix where one subject alone has it.
/// What stays in force of provenance: samples that change their marker keep state, method, covariance,
/// residual and time; samples that are cut become `rejected`, fills are `interpolated` or `model_filled` with
/// their method and standard deviation (the first fill gives every sample a covariance, as fill_gaps() does),
/// unfilled samples are `missing`.
///
/// Code::bad_input, "line 7: swap: why not", for an operation that cannot be applied: a marker that is not
/// there (with the nearest names), frames or times outside the recording, samples where a relabel would put
/// others, nothing to cut, fill or unfill, an event that is not there; also for undo and redo, which
/// EditList::edits_in_force() resolves. Code::cancelled when `progress` says so. A fill costs as one of
/// fill_gaps(), others O(samples).
[[nodiscard]] Result<EditedTrial> apply_edits(EditedTrial state, std::span<const data::Edit> in_force,
                                              const EditOptions& options = {});

/// The same with undo and redo in the list, on a recording as it was read.
[[nodiscard]] Result<EditedTrial> apply_edits(data::Trial trial, const data::EditList& list,
                                              const EditOptions& options = {});

}  // namespace kinemark::trajectory
