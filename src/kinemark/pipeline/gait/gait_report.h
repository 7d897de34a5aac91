// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A gait report for any job that has curves over the cycle: how far walking is from a norm (Movement Analysis
// Profile, Gait Profile Score), one page to read and to print, and files.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/angle_angle.h"
#include "kinemark/pipeline/gait/gait_figures.h"
#include "kinemark/pipeline/gait/gait_norms.h"
#include "kinemark/pipeline/gait/gait_sheet.h"

namespace kinemark::pipeline {

/// The root mean square over the cycle of what a mean curve differs from the norm's mean.
struct GaitVariableScore {
  std::string title;                            ///< of its panel
  std::array<double, 2> value_deg{kNaN, kNaN};  ///< left, right; NaN: not known at every point
};

/// Baker et al. 2009 (Gait & Posture 30:265-269). `scores` is the Movement Analysis Profile, as far as there
/// are curves and norms. The Gait Profile Score of a side is the root mean square of nine scores: pelvic
/// tilt, obliquity and rotation, hip flexion, adduction and rotation, knee flexion, ankle dorsiflexion, foot
/// progression; that of both sides is of fifteen, the pelvis counted once, from the left cycle. The paper
/// takes 51 points of the cycle, here are those of the curves.
struct GaitDeviation {
  std::vector<GaitVariableScore> scores;       ///< in the order of the nine; empty: no norm has means
  std::array<double, 2> side_deg{kNaN, kNaN};  ///< left, right; NaN: one of the nine is not known
  double both_deg = kNaN;                      ///< NaN: one of the fifteen is not known
  std::vector<std::string> lacking;            ///< titles of those of the nine that are not known
};

/// Of a sheet with norms; without a mean curve in them it is empty.
[[nodiscard]] GaitDeviation gait_deviation(const GaitSheet& sheet);

/// What stands on the page besides the sheet.
struct GaitPageFacts {
  std::string angles_from;              ///< "Plug-in Gait", "outputs of the recording's model"
  std::string command_line;             ///< as typed; may be empty
  std::vector<data::InputFile> inputs;  ///< files that were read
  std::vector<std::string> warnings;    ///< of the job; one sentence each
  std::vector<data::Gate> gates;        ///< bounds that the job had to meet
};

/// One HTML page that needs nothing else, made by the viewer (docs/formats/pages.md, GaitPage): what must be
/// known, the figures, measures left and right with intervals and norms, scores, events, how to read it. The
/// same sheet gives the same bytes.
[[nodiscard]] std::string gait_page(const GaitSheet& sheet, const GaitDeviation& deviation,
                                    std::span<const GaitFigure> figures, const GaitPageFacts& facts);

/// What a report is asked to show besides what there is.
struct GaitReportRequest {
  std::vector<std::filesystem::path> norms;  ///< read_gait_norms()
  std::vector<std::string> angle_angle;      ///< angle_pairs(); empty: hip and knee, knee and ankle

  /// Whether something is asked for. @return Code::usage for a pair that is not A:B
  [[nodiscard]] Status check() const;
};

/// A report, ready to be written.
struct GaitReport {
  GaitSheet sheet;                  ///< in numbers
  GaitDeviation deviation;          ///< from the norm
  std::vector<AnglePair> pairs;     ///< of the sheet's panels
  std::vector<GaitFigure> figures;  ///< the sheet's, then one a pair
};

/// Lay out and draw; pairs that are not there become remarks of the sheet. On the heap, where the sheet's
/// panels stay for the pairs.
[[nodiscard]] std::unique_ptr<GaitReport> make_gait_report(const std::string& trial,
                                                           const std::vector<SheetInput>& curves,
                                                           const analysis::Gait& gait, const GaitNorms& norms,
                                                           const std::vector<std::string>& angle_angle);

/// Names of the files of figures and tables: NAME.FORMAT, gait_curves.csv, and gait_pairs.csv where there are
/// pairs.
[[nodiscard]] std::vector<std::string> gait_report_files(const GaitReport& report,
                                                         const std::vector<std::string>& formats);

/// These files in a folder, to be staged by these names. The report must outlive them.
[[nodiscard]] std::vector<ResultFile> gait_report_results(const GaitReport& report,
                                                          const std::filesystem::path& folder,
                                                          const std::vector<std::string>& formats);

/// The page of the report.
[[nodiscard]] std::string gait_report_page(const GaitReport& report, const GaitPageFacts& facts);

}  // namespace kinemark::pipeline
