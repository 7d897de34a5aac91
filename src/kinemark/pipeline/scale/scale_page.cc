// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_page.h"

#include <utility>
#include <vector>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/scale/scale_json.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

using report::Notice;
using report::Verdict;

std::vector<Notice> notices(const std::vector<std::string>& sentences) {
  std::vector<Notice> out;
  for (const auto& sentence : sentences) out.push_back({.text = sentence});
  return out;
}

std::vector<report::NoticeGroup> groups_of(const ScaleOutcome& outcome) {
  std::vector<report::NoticeGroup> groups;
  report::add_gates(groups, outcome.gates);
  for (const auto* adapted : {&outcome.from_static, &outcome.from_motion}) {
    if (!*adapted) continue;
    const auto& result = **adapted;
    if (!result.converged)
      report::add_group(groups, Verdict::attention, "fit", "fit that did not converge", "",
                        {{.text = "The fit of the sizes stopped at its largest number of steps."}});
    report::add_group(groups, Verdict::good, "size", "number that these data do not determine",
                      "numbers that these data do not determine", notices(result.not_determined));
    report::add_group(groups, Verdict::good, "size", "recommendation", "recommendations",
                      notices(result.recommendations));
  }
  report::add_group(groups, Verdict::good, "file", "part of the file that was not kept",
                    "parts of the file that were not kept", notices(outcome.lost));
  report::add_remarks(groups, outcome.warnings);
  return groups;
}

}  // namespace

std::string scale_page(const ScaleJob& job, const ScaleOutcome& outcome) {
  return report::result_report_html({.kind = "scale",
                                     .trial = job.output.filename().string(),
                                     .version = std::string(kVersion),
                                     .command_line = job.command_line,
                                     .groups = groups_of(outcome),
                                     .result = scale_json(job, outcome)});
}

}  // namespace kinemark::pipeline
