// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which segments and joints a search for joints is about: those that are given or those that the data
// show, without what is no body's.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/skeleton/plausibility/plausibility.h"
#include "kinemark/workflow/joints/joints.h"

namespace kinemark::workflow {

/// Fills outcome.layout: the segments that are given, or those of find_segmentation() with its known joints.
/// What the markers contradict goes into outcome.left_out; of a subject's layout the articulated method gets
/// segments of two markers or more.
[[nodiscard]] Status lay_out(const JointsOptions& options, const data::Trajectories& markers,
                             JointsFound& outcome);

/// Takes segments and joints out of a layout and into outcome.left_out. Code::bad_input in one sentence,
/// which names the worst of all that were left out and what to do next, where no joint of a layout that was
/// given is left.
[[nodiscard]] Status leave_out(const JointsOptions& options, std::span<const skeleton::Implausible> bad,
                               data::SegmentLayout& layout, JointsFound& outcome);

/// Parts of a layout that joints connect, of two segments or more, in the order of their first segments.
[[nodiscard]] std::vector<data::SegmentLayout> trees_of(const data::SegmentLayout& layout);

/// An error of what is solved after something was left out: the same, and what that was.
[[nodiscard]] Error with_left_out(const JointsFound& outcome, const Error& error);

/// What to do about outcome.left_out, one sentence.
[[nodiscard]] std::string propose_next_step(const JointsOptions& options, const JointsFound& outcome);

}  // namespace kinemark::workflow
