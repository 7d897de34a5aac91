// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/level_arguments.h"

#include <fmt/core.h>

#include <utility>

namespace kinemark::cli {

Status take_levels(const std::vector<std::string>& texts, motion::TrackOptions& options) {
  for (const auto& text : texts) {
    auto level = motion::TrackLevel::parse(text);
    if (!level) return std::unexpected(level.error());
    options.levels.push_back(std::move(*level));
  }
  if (options.strict && options.levels.size() < 2 && !options.propose_levels)
    return fail(Code::usage, fmt::format("--strict is for several levels; --level is given {} times",
                                         options.levels.size()));
  return {};
}

}  // namespace kinemark::cli
