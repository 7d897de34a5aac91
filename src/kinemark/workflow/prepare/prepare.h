// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording as it is to be used: edited, selected, turned. Every verb starts from one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/recording.h"
#include "kinemark/workflow/prepare/axes.h"
#include "kinemark/workflow/prepare/selection.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::workflow {

/// What of a recording is held against what else is known of it: what the result of a verb rests on.
struct HeldFacts {
  bool size = true;     ///< of the body, against people's
  bool sides = true;    ///< left and right by names, against where a body has them
  bool pairs = true;    ///< markers of pelvis and legs by names, against where a body has them
  bool plates = true;   ///< forces, where the recording has them, against feet and mass
  bool events = false;  ///< the file's against each other and against the feet

  [[nodiscard]] static HeldFacts none() { return {false, false, false, false, false}; }  ///< nothing
  [[nodiscard]] static HeldFacts all() { return {true, true, true, true, true}; }        ///< everything
};

/// What is done to a recording before anything is computed from it, in this order.
struct PrepareOptions {
  std::vector<data::Edit> edits = {};  ///< operations of a person, undo and redo among them
  bool one_time = false;               ///< then the markers of each frame at one time
  Selection selection = {};            ///< then markers, names, frames
  AxesChoice axes = {};                ///< then which way is up, or a rotation
  HeldFacts facts = {};                ///< of what is left
  std::uint64_t seed = 1;              ///< of fills among the edits
  int threads = 1;                     ///< 0: all cores. Any number gives the same bits.

  /// What can be said without a recording: Code::usage.
  [[nodiscard]] Status check() const;
};

/// The recording as the options ask for it; forces of plates follow its frames and axes. What was done is
/// added to its notes. Defects and samples that the recorder made are not looked for here: each verb does
/// that by its own rules (screen_markers()), in what is left. What contradicts what else is known goes into
/// its notes and into `contradicted`.
///
/// Code::usage as PrepareOptions::check(); Code::bad_input as trajectory::apply_edits() and take_selection().
/// O(samples), a fill as trajectory::fill_gaps().
[[nodiscard]] Result<data::Recording> prepare(data::Recording recording, const PrepareOptions& options = {});

/// The first step of prepare(): operations in force, in their order. What they could do in part only is added
/// to the recording's notes. Fails as trajectory::apply_edits(); the recording is then as it was.
[[nodiscard]] Status apply_edits(data::Recording& recording, std::span<const data::Edit> in_force,
                                 std::uint64_t seed = 1, int threads = 1);

/// The axis that is said to point up; none: nobody says one, or it is to be found. `axes` are checked.
[[nodiscard]] std::optional<Vertical> stated_vertical(const AxesChoice& axes);

}  // namespace kinemark::workflow
