// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Signals over each other on one axis of time, as a data sheet draws them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/stages/report/figures/canvas.h"

namespace kinemark::report {

/// A signal; levels 0 to 1. Sizes agree.
struct TimingTrace {
  std::string name;
  Eigen::VectorXd time, level;
  double width = 1.4;  ///< pixels
};

/// A length of time with its name, drawn with arrows below the traces.
struct TimingSpan {
  double from = 0.0, to = 0.0;
  std::string text;
};

struct TimingDiagram {
  std::string time_label;  ///< "time, ms"
  double begin = 0.0, end = 1.0;
  std::vector<TimingTrace> traces;  ///< from above
  std::vector<TimingSpan> spans;    ///< one below the other where they would touch
};

/// Pixels that a diagram needs from top to bottom.
[[nodiscard]] double height_of(const TimingDiagram& diagram);
void draw(const TimingDiagram& diagram, Canvas& canvas, const CanvasRoom& room);

}  // namespace kinemark::report
