// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/result_report.h"

#include <utility>

#include "kinemark/stages/report/internal/json_parts.h"
#include "kinemark/stages/report/internal/page.h"

namespace kinemark::report {
namespace {

using Json = nlohmann::ordered_json;

Json clock_of(const ResultReport& report) {
  if (!report.scene) return nullptr;
  const auto& time = report.scene->markers->time;
  return {{"frames", time.frames},
          {"rate_hz", internal::number(time.rate_hz, 9)},
          {"first_time_s", internal::number(time.t0_s, 9)},
          {"first_frame", report.first_frame}};
}

}  // namespace

void add_gates(std::vector<NoticeGroup>& groups, std::span<const Gate> gates) {
  std::vector<Notice> missed;
  for (const auto& gate : gates)
    if (!gate.passed) missed.push_back({.subject = gate.name, .text = gate.sentence});
  add_group(groups, Verdict::attention, "gate", "quality check missed", "quality checks missed",
            std::move(missed));
}

void add_remarks(std::vector<NoticeGroup>& groups, std::span<const std::string> remarks) {
  std::vector<Notice> items;
  for (const auto& remark : remarks) items.push_back({.text = remark});
  add_group(groups, Verdict::good, "warning", "remark", "remarks", std::move(items));
}

Json result_report_json(const ResultReport& report, const SceneOptions& options) {
  return {{"summary",
           {{"schema", "kinemark.result_report"},
            {"schema_version", 1},
            {"kind", report.kind},
            {"trial", report.trial},
            {"verdict", to_string(verdict_of(report.groups))},
            {"version", report.version},
            {"command_line", report.command_line},
            {"groups", internal::groups_json(report.groups)},
            {"inputs", inputs_json(report.inputs)},
            {"clock", clock_of(report)}}},
          {"result", report.result},
          {"scene", report.scene ? scene_json(*report.scene, options) : Json(nullptr)}};
}

std::string result_report_html(const ResultReport& report, const SceneOptions& options) {
  return internal::fill_page(result_report_json(report, options));
}

}  // namespace kinemark::report
