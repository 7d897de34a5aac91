// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/regions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "kinemark/core/number.h"
#include "kinemark/core/text.h"

namespace kinemark::workflow {
namespace {

// A frame's number of "120" or "1.2s".
std::optional<std::int64_t> parse_end(std::string_view text, const TimeBase& time) {
  const bool seconds = text.ends_with('s');
  if (seconds) text.remove_suffix(1);
  const auto value = parse_number(text);
  constexpr double kMost = 1e15;
  if (!value || !(std::abs(*value) < kMost)) return std::nullopt;
  if (seconds) return time.number(time.nearest_frame(*value));
  if (*value != std::floor(*value)) return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

std::vector<std::string> labels_of(const data::Trial& trial) {
  std::vector<std::string> out;
  for (const auto& event : trial.events)
    if (std::ranges::find(out, event.label) == out.end()) out.push_back(event.label);
  return out;
}

}  // namespace

Result<data::Region> parse_region(const std::string& text, const TimeBase& time) {
  const auto wrong =
      fail(Code::usage, fmt::format("'{}' is no region; need NAME=FIRST-LAST in frames (reach=120-300) or "
                                    "seconds (reach=1.2s-3s)",
                                    text));
  const auto equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) return wrong;
  const std::string_view ends = std::string_view(text).substr(equals + 1);
  const auto dash = ends.find('-', 1);  // a first number may be negative
  if (dash == std::string_view::npos) return wrong;
  const auto first = parse_end(ends.substr(0, dash), time), last = parse_end(ends.substr(dash + 1), time);
  if (!first || !last) return wrong;
  return data::Region{.name = text.substr(0, equals), .first_frame = *first, .last_frame = *last};
}

Result<std::vector<data::Region>> regions_between(const std::string& label, const data::Trial& trial) {
  const auto& time = trial.markers.time;
  std::map<std::string, std::vector<std::int64_t>> frames;  // by context
  for (const auto& event : trial.events)
    if (event.label == label) frames[event.context].push_back(time.number(time.nearest_frame(event.time_s)));
  std::vector<data::Region> out;
  for (auto& [context, at] : frames) {
    std::ranges::sort(at);
    const auto same = std::ranges::unique(at);
    at.erase(same.begin(), same.end());
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
      out.push_back({.name = fmt::format("{}{}{} {}", label, context.empty() ? "" : " ", context, i + 1),
                     .first_frame = at[i],
                     .last_frame = at[i + 1] - 1});
  }
  if (!out.empty()) return out;
  const auto labels = labels_of(trial);
  return fail(Code::bad_input,
              fmt::format("no two events of one side are called '{}'; {}", label,
                          labels.empty() ? "the recording has no events"
                                         : fmt::format("the recording has {}", join_names(labels, 8))));
}

}  // namespace kinemark::workflow
