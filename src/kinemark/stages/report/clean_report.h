// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What was done to every marker of a recording, and why: `kinemark.clean_report` and its page.
// docs/formats/pages.md describes each member of the JSON.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/data/clean_account.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/report_parts.h"

namespace kinemark::report {

/// Everything about a run that is not in its arrays.
struct CleanRun {
  std::string trial;          ///< name for the heading, usually the input file's
  std::string gap_method;     ///< as asked: "none", "auto", "cubic", ...
  std::string filter_method;  ///< as asked: "none", "auto", "kalman", ...
  std::string version;        ///< of the program
  std::string command_line;   ///< as typed
  std::uint64_t seed = 0;     ///< of artificial gaps
  int threads = 1;            ///< as asked for
  int exit_status = 0;        ///< of the program
  double clean_s = kNaN;      ///< wall-clock seconds without reading and writing
  std::vector<std::pair<std::string, std::string>> options;  ///< name and value, as they were used
  std::vector<InputFile> inputs;                             ///< files that were read
  std::vector<Gate> gates;                                   ///< bounds that decide the exit status
  std::vector<std::string> warnings;                         ///< one sentence each
};

/// Samples of one marker by data::SampleState. Made by add_marker().
struct CleanCounts {
  std::array<std::int64_t, 6> before{};  ///< of the recording
  std::array<std::int64_t, 6> after{};   ///< of the result
};

/// What the plots of one marker show, on the points of the page. Made by add_marker().
struct CleanSeries {
  std::int64_t points = 0;      ///< on the page
  std::int64_t frame_step = 1;  ///< frames per point
  /// Per axis: m, m/s, m/s^2; a vector is empty when the result has no such number.
  std::array<std::vector<float>, 3> raw, position, velocity, acceleration;
  /// one standard deviation, likewise
  std::array<std::vector<float>, 3> position_sd, velocity_sd, acceleration_sd;
  std::array<std::vector<float>, 3> change;    ///< raw - position where both are present, m
  std::vector<std::uint8_t> before, after;     ///< data::SampleState by rank, 0 to 5
  std::int64_t place_step = 1;                 ///< frames per place
  std::vector<Eigen::Vector3f> positions;      ///< of the result in every place_step-th frame, m; NaN: absent
  std::vector<data::SampleState> place_state;  ///< likewise
};

/// The report of a cleaned recording. Plain data: fill `run`, `time` and all of `account` but its markers,
/// and add these one by one, from the first to the last, with add_marker().
struct CleanReport {
  CleanRun run;                     ///< who ran what
  TimeBase time;                    ///< of the result
  data::CleanAccount account;       ///< what was done and why
  std::vector<CleanCounts> counts;  ///< one per marker of the account
  std::vector<CleanSeries> series;  ///< one per marker of the account
};

/// The arrays of one marker, borrowed for the call. A result that comes marker by marker is handed over as
/// trajectories and derivatives of one marker.
struct MarkerArrays {
  const data::Trajectories* before = nullptr;      ///< the whole recording, on the clock of the result
  std::int64_t before_marker = 0;                  ///< its index there
  const data::Trajectories* after = nullptr;       ///< the result
  std::int64_t after_marker = 0;                   ///< its index there
  const data::Derivatives* derivatives = nullptr;  ///< of `after`; nullptr: not known
};

/// Append a marker: its account, its samples by state, and its plots, thinned to the points of the options,
/// and further where there are many markers. Neither array is needed afterwards. When the frames were
/// decimated, `before` is the recording after that. O(F).
void add_marker(CleanReport& report, data::MarkerAccount account, const MarkerArrays& arrays,
                const ReportOptions& options = {});

/// What needs attention, the serious ones first: defects that were found but not handled, samples that the
/// recorder made, fills with a large standard deviation, failed gates; and in notes: gaps left open,
/// residuals that are not white, filters at the end of their range, warnings.
[[nodiscard]] std::vector<Notice> clean_findings(const CleanReport& report);

/// `kinemark.clean_report`, version 2: the whole account without the arrays. Lengths in mm, times in s,
/// unknown numbers null.
[[nodiscard]] nlohmann::ordered_json clean_summary_json(const CleanReport& report);

/// The data that the page draws: `{"summary": ..., "series": {...}}`. Of more than 3,000 gaps or defects the
/// summary holds the longest ones; the JSON of clean_summary_json() holds all. Curves are thinned to the
/// bound of the options.
[[nodiscard]] nlohmann::ordered_json clean_report_json(const CleanReport& report,
                                                       const ReportOptions& options = {});

/// The whole page. Equal reports give equal bytes: it holds no time of day and no machine name.
/// Names and sentences may hold any bytes: they cannot end the data block and are shown as text only.
[[nodiscard]] std::string clean_report_html(const CleanReport& report, const ReportOptions& options = {});

}  // namespace kinemark::report
