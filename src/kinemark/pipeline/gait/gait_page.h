// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A gait report as one page to read and to print.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/gait/gait_deviation.h"
#include "kinemark/pipeline/gait/gait_figures.h"
#include "kinemark/pipeline/gait/gait_sheet.h"

namespace kinemark::pipeline {

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

}  // namespace kinemark::pipeline
