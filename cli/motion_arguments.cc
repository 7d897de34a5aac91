// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/motion_arguments.h"

#include "cli/console.h"
#include "cli/many_inputs.h"
#include "kinemark/core/number.h"
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
  for (const auto& notice : outcome.summary.notices) {
    const bool note = notice.level == report::Verdict::good;
    if (note && notice.about == "coordinate") continue;
    say(common, fmt::format("{}: {}", note ? "note" : "attention", notice.text));
  }
  say_written(common, outcome);
  if (common.json) print_result(pipeline::json_text(report::summary_json(outcome.summary)) + "\n");
}

}  // namespace kinemark::cli
