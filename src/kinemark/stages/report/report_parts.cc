// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/report_parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace kinemark::report {

std::string_view to_string(Verdict verdict) { return verdict == Verdict::good ? "good" : "attention"; }

Status ReportOptions::check() const {
  if (max_points < 2) return fail(Code::usage, fmt::format("max_points is {}; need 2 or more", max_points));
  if (max_data_bytes < 2000)
    return fail(Code::usage, fmt::format("max_data_bytes is {}; need 2000 or more", max_data_bytes));
  return {};
}

void add_group(std::vector<NoticeGroup>& groups, Verdict level, std::string_view about, std::string_view one,
               std::string_view many, std::vector<Notice> items) {
  if (items.empty()) return;
  for (auto& item : items) item.level = level, item.about = about;
  groups.push_back(
      {level, fmt::format("{} {}", items.size(), items.size() == 1 ? one : many), std::move(items)});
}

Verdict verdict_of(const std::vector<NoticeGroup>& groups) {
  const bool attention =
      std::ranges::any_of(groups, [](const auto& g) { return g.level == Verdict::attention; });
  return attention ? Verdict::attention : Verdict::good;
}

}  // namespace kinemark::report
