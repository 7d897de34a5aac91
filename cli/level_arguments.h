// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/motion/track_job.h"

namespace kinemark::cli {

/// Put the values of --level, each MARKER,MARKER,..., into the options, and check --strict, which is there
/// already.
[[nodiscard]] Status take_levels(const std::vector<std::string>& texts, motion::TrackOptions& options);

}  // namespace kinemark::cli
