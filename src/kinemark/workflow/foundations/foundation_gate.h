// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The gate in front of everything that builds on a static trial.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/foundations/standing_body.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// Judge a still recording and add the gate `static_trial` to the remarks: missed where a pair is exchanged
/// or a marker lies elsewhere, with a warning for each that names it; a warning too where its posture
/// changes. No gate where too few markers are known. Fails as motion::judge_foundation(), naming the trial.
/// @param name  what its sentences call the recording by
[[nodiscard]] Result<motion::FoundationJudgement> judge_static_trial(
    const std::string& name, const motion::StandingBody& body, const data::Trajectories& still,
    std::span<const data::Trajectories* const> movements, Remarks& remarks);

/// Pairs of pelvis and legs that are exchanged throughout a recording in which somebody moves. Fails as
/// motion::judge_movement(), naming the recording.
[[nodiscard]] Result<std::vector<motion::FoundationFinding>> find_exchanged_pairs(
    const std::string& name, const data::Trajectories& recording);

/// Which labels two markers of a recording have, as a body has markers of their names: 1: their own, -1: each
/// other's throughout, 0: the body does not tell. Pairs of pelvis and legs are asked without the rest of the
/// body. As motion::score_exchange().
[[nodiscard]] int side_by_body(const data::Trajectories& recording, std::int64_t one, std::int64_t other);

/// Judge pairs of pelvis and legs throughout a recording in which somebody moves, and add the gate
/// `recording` to the remarks: missed where a pair is exchanged, with a warning that names it. No gate where
/// too few markers are known, or nothing is found.
/// @param consequence  what comes of it, the end of the sentence: "all is computed with them exchanged back"
[[nodiscard]] Result<std::vector<motion::FoundationFinding>> judge_recording(
    const std::string& name, const data::Trajectories& recording, const std::string& consequence,
    Remarks& remarks);

/// A warning where a recording of any movement shows the mirror image of the body.
void note_mirrored(const std::string& name, const motion::StandingBody& body,
                   const data::Trajectories& recording, std::vector<std::string>& warnings);

}  // namespace kinemark::workflow
