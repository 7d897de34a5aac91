// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/level_arguments.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace kinemark::cli {

Status take_levels(const std::vector<std::string>& texts, motion::TrackOptions& options) {
  for (const auto& text : texts) {
    motion::TrackLevel level;
    for (std::size_t begin = 0; begin <= text.size();) {
      const auto end = std::min(text.find(',', begin), text.size());
      if (end == begin)
        return fail(Code::usage, fmt::format("level '{}' has an empty name; need MARKER,MARKER,...", text));
      level.markers.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    options.levels.push_back(std::move(level));
  }
  if (options.strict && options.levels.size() < 2)
    return fail(Code::usage, fmt::format("--strict is for several levels; --level is given {} times",
                                         options.levels.size()));
  return {};
}

}  // namespace kinemark::cli
