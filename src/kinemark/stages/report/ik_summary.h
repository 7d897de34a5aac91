// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One solved trial in numbers: what Q_report.json holds and what the report page shows around its plots.
// docs/formats/pages.md describes each member of the JSON.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/report_parts.h"

namespace kinemark::report {

/// How far a coordinate may go.
struct CoordinateLimits {
  std::string coordinate;       ///< in the model
  double min = 0.0, max = 0.0;  ///< rad or m
};

/// Everything about a run that is not in its arrays. The caller fills this in.
struct IkRun {
  std::string trial;         ///< name for the heading, usually the marker file's
  std::string model;         ///< the model's own name
  std::string method;        ///< "least squares" or "direct marker control"
  std::string version;       ///< of the program
  std::string command_line;  ///< as typed
  std::uint64_t seed = 0;    ///< of random starts
  int threads = 1;           ///< as asked for
  int exit_status = 0;       ///< of the program
  double solve_s = kNaN;     ///< wall-clock seconds of the solve alone
  std::vector<std::pair<std::string, std::string>> options;  ///< name and value, as they were used
  std::vector<InputFile> inputs;                             ///< files that were read
  std::vector<Gate> gates;                                   ///< bounds that decide the exit status
  /// Of names, weights, noise, what was left out and findings; errors are computed from the motion, and its
  /// warnings stand in `warnings`. Markers that are not listed have the weight 1.
  data::MarkerFit fit;
  std::vector<std::string> locked_coordinates;  ///< held fixed by the model or the user
  std::vector<CoordinateLimits> limits;         ///< of the coordinates that have any
  double mass_kg = kNaN;                        ///< of the model's bodies together; NaN: not known
  std::vector<std::string> warnings;            ///< one sentence each
  bool by_sensors = false;                      ///< orientations alone fix the motion; not kept in the JSON
};

/// One coordinate over the recording.
struct CoordinateSummary {
  std::string name;                           ///< in the model
  bool is_rotation = true;                    ///< true: rad, false: m
  bool keeps_radians = false;                 ///< MOT and STO files hold it in rad
  bool locked = false;                        ///< the model holds it
  std::int64_t determined_frames = 0;         ///< frames in which the markers fix it
  std::int64_t open_frames = -1;              ///< frames in which no visible marker fixes it; -1: not known
  double min = kNaN;                          ///< rad or m, over determined frames
  double max = kNaN;                          ///< rad or m, over determined frames
  double median_sd = kNaN;                    ///< rad or m, over determined frames
  double limit_min = kNaN, limit_max = kNaN;  ///< rad or m; NaN: none
  std::int64_t at_limit_frames = 0;           ///< determined frames that lie at a limit, or beyond
  std::int64_t first_at_limit = -1;           ///< the first of them; -1: none
};

/// A row of the page's table of markers, used or not.
struct MarkerRow {
  std::string name;                   ///< in the model, or in the recording
  bool used = true;                   ///< false: it took no part
  std::string why_excluded;           ///< a few words; empty when used
  double weight = 1.0;                ///< as given, >= 0
  std::int64_t seen_frames = 0;       ///< frames with an error, or with coordinates for excluded markers
  std::int64_t rejected_frames = 0;   ///< frames in which its sample was left out
  double rms_error_m = kNaN;          ///< of the distance between measured and model marker
  double max_error_m = kNaN;          ///< largest distance; NaN when never seen
  std::int64_t max_error_frame = -1;  ///< its frame; -1 when never seen
  double noise_sd_m = kNaN;           ///< standard deviation along one axis, given or estimated
};

/// A frame that fits badly.
struct WorstFrame {
  std::int64_t frame = 0;                                   ///< index in the motion
  double time_s = 0.0;                                      ///< on the recording's clock
  double rms_error_m = 0.0;                                 ///< over the markers seen in this frame
  int markers_seen = 0;                                     ///< number of markers used
  std::string marker;                                       ///< the one with the largest error
  double marker_error_m = 0.0;                              ///< its distance
  data::FrameStatus status = data::FrameStatus::converged;  ///< how the frame ended
};

/// What a report says of joint angles and their fit.
struct IkSummary {
  IkRun run;                                    ///< who ran what
  TimeBase time;                                ///< of the motion
  Verdict verdict = Verdict::good;              ///< attention: at least one notice of that level
  std::array<std::int64_t, 4> status_frames{};  ///< by FrameStatus
  double determined_fraction = kNaN;            ///< over frames and coordinates that are not locked
  std::int64_t rejected_samples = 0;            ///< left out, of all markers
  double rejected_fraction = kNaN;              ///< of the samples that there were; NaN: not judged
  double rms_error_m = kNaN;                    ///< over all frames and seen markers
  double max_error_m = kNaN;                    ///< over the same
  std::vector<CoordinateSummary> coordinates;   ///< n
  std::vector<MarkerRow> markers;               ///< used ones in the motion's order, then the excluded ones
  std::vector<WorstFrame> worst_frames;         ///< the worst first
  std::vector<Notice> notices;                  ///< the serious ones first
};

/// Options of the summary.
struct SummaryOptions {
  int worst_frames = 20;                 ///< at most, >= 0
  double worst_frame_distance_s = 0.25;  ///< two worst frames are at least this far apart

  [[nodiscard]] Status check() const;  ///< Ranges hold.
};

/// Counts, errors, worst frames and notices of a solved trial.
///
/// @param run      facts that are not in the arrays
/// @param motion   F frames; must be valid
/// @param markers  F frames on the same clock, or nullptr when only the errors are known; looked up by name,
///                 may hold more markers than the motion
/// @return         Fails when the two do not fit together. O(F (n + M)) time.
[[nodiscard]] Result<IkSummary> summarize(IkRun run, const data::JointMotion& motion,
                                          const data::Trajectories* markers,
                                          const SummaryOptions& options = {});

/// What Q_report.json holds. Angles in deg, errors in mm, times in s, unknown numbers null.
[[nodiscard]] nlohmann::ordered_json summary_json(const IkSummary& summary);

/// The run's facts (trial, model, options, inputs, gates, warnings, weights, samples left out, ...) read back
/// from Q_report.json, so that a page can be made from result files. Other counts and errors are not read:
/// summarize() finds them again.
[[nodiscard]] Result<IkRun> run_from_json(const nlohmann::ordered_json& json);

}  // namespace kinemark::report
