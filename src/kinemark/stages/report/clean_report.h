// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What was done to every marker of a recording, and why: `kinemark.clean_report` and its page.
// The JSON is described field by field in README.md.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/time_base.h"
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

/// One filter that was tried: the smaller its criterion, the better.
struct TriedFilter {
  int order = 0;            ///< of the filter
  double cutoff_hz = kNaN;  ///< -3 dB; NaN where it has none
  double criterion = kNaN;  ///< see CleanMarker::criterion_name
};

/// Power spectral density, summed over the axes. All three have one length, or are empty.
struct CleanSpectrum {
  std::vector<double> frequency_hz;        ///< rising, > 0
  std::vector<double> raw_m2_per_hz;       ///< of what went in
  std::vector<double> residual_m2_per_hz;  ///< of what the filter took away
};

/// What was done to one marker, and why.
struct CleanMarker {
  std::string name;                      ///< of the marker
  std::array<std::int64_t, 6> before{};  ///< samples by data::SampleState; counted by add_marker()
  std::array<std::int64_t, 6> after{};   ///< the same of the result; counted by add_marker()
  data::FilterUsed filter;               ///< as used
  std::string words;                     ///< one or two sentences: what the filter did and why it was chosen
  std::string noise_from;                ///< "given", "covariance", "data"; empty when unknown
  std::string criterion_name;            ///< "SURE, m^2", ...; empty when nothing was chosen
  std::vector<TriedFilter> tried;        ///< one per order
  double residual_rms_m = kNaN;          ///< in - out, per axis
  std::vector<double> autocorrelation;   ///< of the residuals, lags 1, 2, ... frames; empty when unknown
  double ljung_box_p = kNaN;             ///< small: the residual is not white
  bool white = true;                     ///< no more autocorrelation than the filter itself explains
  /// Factors on the model's standard deviations of position, velocity, acceleration and jerk: at seen
  /// samples, and for what gaps and ends add.
  std::array<double, 4> bar_scale{1.0, 1.0, 1.0, 1.0};
  std::array<double, 4> gap_bar_scale{1.0, 1.0, 1.0, 1.0};  ///< likewise, for what gaps and ends add
  std::int64_t bad_variances = 0;                           ///< samples whose variance could not be used
  int upsampling_factor = 1;      ///< 1: not found to be interpolated by the recorder
  std::string upsampling_kernel;  ///< "linear", "cubic spline", ...; empty with factor 1
  std::string band;               ///< what the top of the spectrum says: "open", "low-passed ...", ...
  CleanSpectrum spectrum;         ///< of the marker's samples
};

/// One candidate of a gap's combination.
struct GapWeight {
  std::string name;      ///< of the candidate
  double weight = 0.0;   ///< all weights of a gap sum to 1
  double rms_m = kNaN;   ///< on artificial gaps
  bool guarded = false;  ///< left out: strayed from all others
};

/// One gap, filled or not.
struct CleanGap {
  std::string marker;                   ///< its name
  std::int64_t first_frame = 0;         ///< both ends belong to the gap
  std::int64_t last_frame = 0;          ///< both ends belong to the gap
  bool at_edge = false;                 ///< touches the start or the end of the recording
  bool filled = false;                  ///< false: left open
  std::string method;                   ///< "auto", "cubic", ...; empty when left open
  std::vector<GapWeight> weights;       ///< largest first
  double sd_m = kNaN;                   ///< per axis, RMS over the gap
  double max_sd_m = kNaN;               ///< largest along the gap and over the axes
  int windows = 0;                      ///< artificial gaps that weights and SD come from
  double window_s = kNaN;               ///< their length
  std::vector<std::string> predictors;  ///< markers that the fill leans on
  std::vector<std::string> dropped;     ///< markers not trusted in this gap
  std::string why_open;                 ///< a sentence; empty when filled
};

/// A defect of the recording: from screening or from the label check of the gaps.
struct CleanDefect {
  std::string kind;              ///< "spike", "stuck", "label swap", ...
  std::string marker;            ///< empty: all markers
  std::string other_marker;      ///< partner of a swap, or empty
  std::int64_t first_frame = 0;  ///< both ends belong to it
  std::int64_t last_frame = 0;   ///< both ends belong to it
  double confidence = kNaN;      ///< 0 to 1; unknown counts as certain
  std::string sentence;          ///< what is wrong, with numbers
  std::string done;              ///< in words: "rejected", "left as it is", ...
  bool handled = false;          ///< false with a confidence of 0.8 and more: needs attention
};

/// Whether the recorder made samples, over the whole recording.
struct CleanUpsampling {
  bool looked = false;                 ///< false: nobody looked, the rest means nothing
  int factor = 1;                      ///< of all markers together; 1: not found
  std::vector<std::string> sentences;  ///< for people, the last one says what the test is blind to
  std::string done;                    ///< "marked", "removed", "left as they are", ...
  bool handled = false;                ///< false with a factor above 1: needs attention
};

/// What the plots of one marker show, on the points of the page. Made by add_marker().
struct CleanSeries {
  std::int64_t points = 0;      ///< on the page
  std::int64_t frame_step = 1;  ///< frames per point
  /// Per axis: m, m/s, m/s^2; a vector is empty when the result has no such number.
  std::array<std::vector<float>, 3> raw, position, velocity, acceleration;
  /// one standard deviation, likewise
  std::array<std::vector<float>, 3> position_sd, velocity_sd, acceleration_sd;
  std::array<std::vector<float>, 3> change;  ///< raw - position where both are present, m
  std::vector<std::uint8_t> before, after;   ///< data::SampleState as ranked in README.md
};

/// The report of a cleaned recording. Plain data: fill `run`, `time`, `upsampling`, `gaps` and `defects`, and
/// add the markers one by one with add_marker().
struct CleanReport {
  CleanRun run;                      ///< who ran what
  TimeBase time;                     ///< of the result
  CleanUpsampling upsampling;        ///< of the whole recording
  std::vector<CleanMarker> markers;  ///< M
  std::vector<CleanSeries> series;   ///< one per marker
  std::vector<CleanGap> gaps;        ///< by marker and frame
  std::vector<CleanDefect> defects;  ///< by marker and frame
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

/// Append a marker: its facts, its samples by state, and its plots, thinned so that all markers of `before`
/// together stay within the options. Neither array is needed afterwards. When the frames were decimated,
/// `before` is the recording after that. O(F).
void add_marker(CleanReport& report, CleanMarker facts, const MarkerArrays& arrays,
                const ReportOptions& options = {});

/// What needs attention, the serious ones first: defects that were found but not handled, samples that the
/// recorder made, fills with a large standard deviation, failed gates; and in notes: gaps left open,
/// residuals that are not white, filters at the end of their range, warnings.
[[nodiscard]] std::vector<Notice> clean_findings(const CleanReport& report);

/// `kinemark.clean_report`, version 1: the whole account without the arrays. Lengths in mm, times in s,
/// unknown numbers null.
[[nodiscard]] nlohmann::ordered_json clean_summary_json(const CleanReport& report);

/// The data that the page draws: `{"summary": ..., "series": {...}}`. Of more than 3,000 gaps or defects the
/// summary holds the longest ones; the JSON of clean_summary_json() holds all.
[[nodiscard]] nlohmann::ordered_json clean_report_json(const CleanReport& report);

/// The whole page. Equal reports give equal bytes: it holds no time of day and no machine name.
/// Names and sentences may hold any bytes: they cannot end the data block and are shown as text only.
[[nodiscard]] std::string clean_report_html(const CleanReport& report);

}  // namespace kinemark::report
