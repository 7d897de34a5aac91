// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The gait report of a job that computes angles itself: events from a recording, figures and a page to files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/gait_report.h"
#include "kinemark/pipeline/measures/gait_request.h"
#include "kinemark/stages/analysis/gait/gait.h"

namespace kinemark::pipeline {

/// How walking is measured for what is drawn and written of it.
struct GaitDrawingJob : JobSettings, GaitOutputs {
  std::int64_t refits = 99;  ///< behind each interval of the measures; 0: none
  double level = 0.95;       ///< of these intervals
  double noise_sd_m = 0.0;   ///< of markers, per axis; 0: found from the samples

  /// Whether anything is asked for.
  [[nodiscard]] bool wanted() const {
    return !figures.empty() || !report.empty() || !gait.write_events.empty() || !gait.write_cycles.empty();
  }
};

/// Curves over the cycle with what else a recording has: joint kinetics among its channels, the force of
/// plates under each foot.
void add_recorded_kinetics(const data::Recording& recording, const analysis::Gait& gait,
                           std::vector<SheetInput>& out);

/// The outputs of a gait report, begun before a long computation.
class GaitDrawing {
 public:
  /// Reads the norms, so that what cannot work is reported at once, and adds page, events and cycles to the
  /// files of the job.
  /// @return  Code::usage as GaitRequest::check() and parse_figure_formats(), and for a level that is none;
  /// else
  ///          as read_gait_norms() and Staging::add_page()
  static Result<GaitDrawing> begin(GaitDrawingJob job, Staging& staging);

  /// Find walking in the recording. Code::bad_input as workflow::measure_gait().
  [[nodiscard]] Status find_walking(const data::Recording& recording);
  /// What was found; nothing before find_walking().
  [[nodiscard]] const std::optional<analysis::Gait>& gait() const { return gait_; }

  /// Draw what was asked for; remarks on it become warnings. Walking must have been found.
  /// @param path, trial  the recording
  /// @param curves       angles in SI units, for `write_cycles`
  /// @param inputs       all that is drawn, these curves among them
  /// @param staging      gets the figures, too
  /// @return             files for write_results(); this drawing must outlive them
  [[nodiscard]] Result<std::vector<ResultFile>> draw(const std::filesystem::path& path,
                                                     const data::Trial& trial,
                                                     const std::vector<data::CycleCurves>& curves,
                                                     const std::vector<SheetInput>& inputs,
                                                     GaitPageFacts facts, Staging& staging,
                                                     JobOutcome& outcome);

 private:
  GaitDrawing() = default;
  [[nodiscard]] std::vector<ResultFile> tables(const std::filesystem::path& path, const data::Trial& trial,
                                               const std::vector<data::CycleCurves>& curves);

  GaitDrawingJob job_;
  std::vector<std::string> formats_;
  GaitNorms norms_;
  std::optional<analysis::Gait> gait_;
  data::Trial recorded_;  ///< with the events
  std::unique_ptr<GaitReport> report_;
};

}  // namespace kinemark::pipeline
