// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/report_parts.h"

#include <fmt/core.h>

namespace kinemark::report {

std::string_view to_string(Verdict verdict) { return verdict == Verdict::good ? "good" : "attention"; }

Status ReportOptions::check() const {
  if (max_points < 2) return fail(Code::usage, fmt::format("max_points is {}; need 2 or more", max_points));
  if (max_series_bytes < 1000)
    return fail(Code::usage, fmt::format("max_series_bytes is {}; need 1000 or more", max_series_bytes));
  return {};
}

}  // namespace kinemark::report
