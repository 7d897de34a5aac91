// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What was judged of a static trial, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "kinemark/stages/motion/foundations/judge.h"

namespace kinemark::pipeline {

/// "judged" (names), "movements", "seen_at_50_mm", "mirrored", "findings": each "marker", "partner" or null,
/// "shift_m" and "shift_sd_m" (forward, up, to the right), "by_movement", "where" ("still", "movement" or
/// "either"), "score", "rivals", "sentence".
/// @param file  what its sentences call the recording by, a file's name
[[nodiscard]] nlohmann::ordered_json foundation_json(const std::string& file,
                                                     const motion::FoundationJudgement& judgement);

}  // namespace kinemark::pipeline
