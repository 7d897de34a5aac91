// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_page.h"

#include <fmt/core.h>

#include <utility>
#include <vector>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/joints/joints_json.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

using report::Notice;
using report::Verdict;

/// Joints that some frames do not place.
std::vector<Notice> partly_placed(const data::Skeleton& skeleton) {
  std::vector<Notice> out;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    std::int64_t open = 0;
    for (std::int64_t f = 0; f < skeleton.frames(); ++f)
      if (skeleton.state[skeleton.index(f, static_cast<std::int64_t>(j))] == data::CentreState::undetermined)
        ++open;
    if (open > 0 && open < skeleton.frames())
      out.push_back({.subject = skeleton.joints[j].name,
                     .text = fmt::format("{}: not placed in {} of {} frames.", skeleton.joints[j].name, open,
                                         skeleton.frames())});
  }
  return out;
}

std::vector<report::NoticeGroup> groups_of(const JointsOutcome& outcome) {
  std::vector<report::NoticeGroup> groups;
  std::vector<Notice> left_out, open, slips, doubts;
  for (const auto& bad : outcome.left_out) left_out.push_back({.subject = bad.name, .text = bad.sentence()});
  std::vector<data::Gate> others;
  for (const auto& gate : outcome.gates)
    if (gate.name == "determined")
      open.push_back({.text = gate.sentence});
    else if (gate.name != "plausible")
      others.push_back(gate);
  for (const auto& slip : outcome.slips)
    slips.push_back({.text = sentence_of(slip, outcome.skeleton.time),
                     .time_s = outcome.skeleton.time.time_s(slip.first_frame)});
  for (const auto& warning : outcome.skeleton.warnings) doubts.push_back({.text = warning});
  report::add_gates(groups, others);
  report::add_group(groups, Verdict::attention, "joint", "joint not determined", "joints not determined",
                    std::move(open));
  report::add_group(groups, Verdict::attention, "joint", "segment or joint left out as no body's",
                    "segments and joints left out as no body's", std::move(left_out));
  report::add_group(groups, Verdict::attention, "joint", "doubt about the fit", "doubts about the fit",
                    std::move(doubts));
  report::add_group(groups, Verdict::good, "marker", "marker that moved on its segment",
                    "markers that moved on their segments", std::move(slips));
  report::add_group(groups, Verdict::good, "joint", "joint not placed in some frames",
                    "joints not placed in some frames", partly_placed(outcome.skeleton));
  report::add_remarks(groups, outcome.warnings);
  return groups;
}

}  // namespace

std::string joints_page(const JointsJob& job, const JointsOutcome& outcome, std::int64_t first_frame) {
  return report::result_report_html(
      {.kind = "joints",
       .trial = job.input.filename().string(),
       .version = std::string(kVersion),
       .command_line = job.command_line,
       .groups = groups_of(outcome),
       .inputs = {outcome.input},
       .result = joints_json(job, outcome),
       .scene = report::Scene{.markers = &outcome.used,
                              .skeleton = outcome.skeleton.joints.empty() ? nullptr : &outcome.skeleton},
       .first_frame = first_frame});
}

}  // namespace kinemark::pipeline
