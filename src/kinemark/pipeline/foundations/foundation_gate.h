// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The gate in front of everything that builds on a static trial.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::pipeline {

/// workflow::judge_static_trial(), its remarks added to those of the outcome.
/// @param file  what its sentences call the recording by, a file's name
[[nodiscard]] Result<motion::FoundationJudgement> judge_static_trial(
    const std::string& file, const motion::StandingBody& body, const data::Trajectories& still,
    std::span<const data::Trajectories* const> movements, JobOutcome& outcome);

/// "judged" (names), "movements", "findings": each "marker", "partner" or null, "shift_m" and "shift_sd_m"
/// (forward, up, to the right), "by_movement", "score", "rivals", "sentence".
[[nodiscard]] nlohmann::ordered_json foundation_json(const std::string& file,
                                                     const motion::FoundationJudgement& judgement);

}  // namespace kinemark::pipeline
