// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a page shows of cycles: each of them, and their mean.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/data/measure.h"

namespace kinemark::report {

/// Cycles of one coordinate and one foot over each other.
struct CycleOverlay {
  data::CycleCurves curves;          ///< `id` names the coordinate, `context` the foot: "Left" or "Right"
  std::vector<double> mean;          ///< P, over all cycles that have a value there; NaN of none
  std::vector<double> sd;            ///< P, between cycles, N - 1; NaN of fewer than two
  std::vector<std::int64_t> cycles;  ///< P, that have a value there
};

/// One cycle of a foot.
struct CycleSpan {
  data::Side side = data::Side::left;  ///< of the foot
  double start_s = 0.0;                ///< its strike, on the clock of the recording
  double end_s = 0.0;                  ///< its next strike
};

/// Cycles that a page draws of one overlay at most, evenly chosen; its mean is that of all.
inline constexpr std::int64_t kMostCyclesDrawn = 20;

/// EncodedCycles of docs/formats/pages.md: `null` without overlays. Angles in deg, lengths in m.
[[nodiscard]] nlohmann::ordered_json cycles_json(std::span<const CycleOverlay> overlays);

/// CycleSpans of docs/formats/pages.md: `null` without cycles.
[[nodiscard]] nlohmann::ordered_json cycle_spans_json(std::span<const CycleSpan> cycles);

}  // namespace kinemark::report
