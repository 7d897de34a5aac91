// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A gait report as files, for any job that has curves over the cycle.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/angle_angle.h"
#include "kinemark/pipeline/gait/gait_norms.h"
#include "kinemark/pipeline/gait/gait_page.h"
#include "kinemark/pipeline/gait/gait_sheet.h"

namespace kinemark::pipeline {

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
