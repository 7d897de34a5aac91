// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What measures are worth when they are taken again.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/analysis/groups/reliability.h"

namespace kinemark::pipeline {

/// What `kinemark groups retest` is asked to do.
struct RetestJob : JobSettings {
  std::vector<std::filesystem::path> inputs;  ///< tables of measures, a value a line
  std::string subject = "participant";        ///< column of who was measured
  std::string session = "session";            ///< column of when
  std::string value = "value";                ///< column of the measure
  std::string sd = "sd";                      ///< column of its measurement noise; this one may be absent
  std::vector<std::string> by;     ///< columns: each combination is tested by itself; empty: those of
                                   ///< measure, subject, context and region that are there
  std::vector<std::string> where;  ///< rows_where()
  double level = 0.95;             ///< of the intervals
  std::filesystem::path output;    ///< .csv or .json; empty: none
};

/// One measure, taken again.
struct Retested {
  std::string name;                   ///< of the combination: "peak_speed RHEE Left"
  std::string unit;                   ///< as in the table; empty: not told
  analysis::Reliability reliability;  ///< values in that unit
};

/// All of them.
struct RetestOutcome : JobOutcome {
  std::vector<Retested> measures;  ///< in the order of the table
};

/// Read, average the values of a subject in a session, test, write. The noise of an average is that of its
/// values by their number. A measure that cannot be tested is a warning; Code::bad_input where none can, and
/// for columns that are not there or hold no number.
[[nodiscard]] Result<RetestOutcome> run_retest(const RetestJob& job);

/// For people, a block a measure.
[[nodiscard]] std::string retest_text(const RetestOutcome& outcome);
/// A line a measure.
[[nodiscard]] std::string retest_csv(const RetestOutcome& outcome);
/// All of it.
[[nodiscard]] nlohmann::ordered_json retest_json(const RetestOutcome& outcome);

}  // namespace kinemark::pipeline
