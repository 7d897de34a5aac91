// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/motion_arguments.h"

#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/many_inputs.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {

Result<std::pair<std::string, double>> parse_pair(const std::string& text, const char* what) {
  const auto equals = text.rfind('=');
  const auto number = equals == std::string::npos ? std::nullopt : parse_number(text.substr(equals + 1));
  if (!number || equals == 0) return fail(Code::usage, fmt::format("'{}' is not NAME={}", text, what));
  return std::pair{text.substr(0, equals), *number};
}

std::filesystem::path motion_beside(const std::vector<std::filesystem::path>& recordings) {
  if (recordings.size() != 1 || are_many(recordings) || !recordings.front().has_stem()) return {};
  auto motion = recordings.front();
  return motion.replace_extension(".mot");
}

void print_motion(const CommonOptions& common, const pipeline::MotionOutcome& outcome) {
  // A line for each would hide the rest where hardly anything is determined; pages have them all.
  constexpr std::size_t kLines = 6;
  std::vector<std::string> never;
  for (const auto& notice : outcome.summary.notices)
    if (notice.level != report::Verdict::good && notice.about == "coordinate")
      never.push_back(notice.subject);
  const bool many = never.size() > kLines;
  if (many)
    say(common, fmt::format("attention: {} coordinates are never determined by the visible markers: {}",
                            never.size(), join_some(never, kLines)));
  for (const auto& notice : outcome.summary.notices) {
    const bool note = notice.level == report::Verdict::good;
    if (notice.about == "coordinate" && (note || many)) continue;
    say(common, fmt::format("{}: {}", note ? "note" : "attention", notice.text));
  }
  say_written(common, outcome);
  if (common.json) print_result(pipeline::json_text(report::summary_json(outcome.summary)) + "\n");
}

}  // namespace kinemark::cli
