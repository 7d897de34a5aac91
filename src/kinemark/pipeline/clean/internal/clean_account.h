// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the stages tell of a cleaned recording, as the report has it.
#pragma once

#include <span>

#include "kinemark/pipeline/clean/clean_job.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "kinemark/stages/trajectory/screening/upsampling.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::pipeline::internal {

/// Findings of at least this confidence are rejected on request.
inline constexpr double kRejectConfidence = 0.8;

[[nodiscard]] report::CleanRun describe_run(const CleanJob& job, const data::Trial& trial);
[[nodiscard]] report::CleanUpsampling describe_upsampling(const trajectory::UpsamplingReport& found,
                                                          RecorderMade made);
void add_defects(report::CleanReport& report, std::span<const trajectory::Finding> findings, bool rejected,
                 const std::vector<std::string>& names);
void add_gaps(report::CleanReport& report, const trajectory::GapResult& filled,
              const std::vector<std::string>& names);
/// Facts of one marker; its counts are left to report::add_marker().
[[nodiscard]] report::CleanMarker describe_marker(const trajectory::MarkerAccount& account,
                                                  const trajectory::UpsamplingReport& found,
                                                  std::int64_t marker);

}  // namespace kinemark::pipeline::internal
