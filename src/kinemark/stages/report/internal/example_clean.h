// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/data/derivatives.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/clean_report.h"

namespace kinemark::report::internal {

/// A synthetic cleaned recording with everything a report must show: twelve markers of a swinging arm with
/// noise, gaps filled by several methods and one left open, a spike that was rejected, a label swap that was
/// only flagged, samples that the recorder made, and a residual that is not white. For tests and for looking
/// at the page.
struct ExampleClean {
  CleanReport report;  ///< with `run` and `account`; no markers yet
  std::vector<data::MarkerAccount> accounts;
  data::Trajectories before, after;
  data::Derivatives derivatives;

  /// The report with all its markers.
  [[nodiscard]] CleanReport finished(const ReportOptions& options = {}) const;
};

/// The same seed and length give the same bits. Needs at least 100 frames.
[[nodiscard]] ExampleClean example_clean(std::int64_t frames = 1200, std::uint64_t seed = 7);

}  // namespace kinemark::report::internal
