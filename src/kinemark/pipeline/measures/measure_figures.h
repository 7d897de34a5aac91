// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Paths of markers as people print them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/stages/analysis/path/path_curves.h"
#include "kinemark/stages/report/figures/figure.h"

namespace kinemark::pipeline {

/// A figure and the stem of its file.
struct NamedFigure {
  std::string name;       ///< "RFIN_reach_path": letters, digits, '.', '_' and '-'
  report::Figure figure;  ///< what it shows
};

/// Figures of a stretch: the path in its best-fit plane with axes and extent, and its height over that plane;
/// speed and tangential acceleration over time with one standard deviation, onset, end and cycles; of a
/// periodic movement the cycles over each other with their mean.
[[nodiscard]] std::vector<NamedFigure> measure_figures(const analysis::PathCurves& curves);

/// Formats that figures are written in, for people.
inline constexpr std::string_view kFigureFormats = "svg and png";

/// "svg", "png" or both with a comma between; empty: all that this program can write. Code::usage for others;
/// Code::not_supported for png in a program without Cairo.
[[nodiscard]] Result<std::vector<std::string>> parse_figure_formats(const std::string& text);

/// The content of the figure's file in a format. Code::not_supported as figure_png().
[[nodiscard]] Result<std::string> figure_file(const report::Figure& figure, const std::string& format);

/// The page of a recording's measures: what stands out, figures, what lies beside the movement, the table.
/// @param neural  report::neural_json(); null: nothing
[[nodiscard]] std::string measures_page(const MeasuresJob& job, const MeasuresOutcome& outcome,
                                        const std::vector<NamedFigure>& figures,
                                        const nlohmann::ordered_json& neural = nullptr);

}  // namespace kinemark::pipeline
