// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Real walks and runs judged by markers alone, and what becomes of them where they are spoiled.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/gait/gait.h"

namespace kinemark::acceptance {

/// A recording of the test data, and what it shows: "walk ground forward" is manner, surface, direction ("?":
/// no front of foot or pelvis is named).
struct GaitRecording {
  const char *file, *laboratory, *kind;
};

/// A recording and what markers alone tell of it.
struct GaitFound {
  data::Trial trial;
  analysis::Gait gait;
  GaitRecording recording;
};

/// From an end of a recording, within which an event is not asked for.
inline constexpr double kEnd_s = 0.1;

/// Events and kind by markers alone.
[[nodiscard]] Result<analysis::Gait> by_markers(const data::Trajectories& markers, std::int64_t refits = 0);

/// The event of the same foot and kind that lies nearest, within 0.15 s; null: none.
[[nodiscard]] const data::GaitEvent* nearest(const std::vector<data::GaitEvent>& events,
                                             const data::GaitEvent& to);

/// As GaitRecording::kind.
[[nodiscard]] std::string kind_of(const analysis::Gait& gait);

/// Percent.
[[nodiscard]] double share(double of, double all);

/// Rows of recordings with fewer frames, noise, gaps, leaps, turned axes: their events and kind stay.
void judge_spoils(const std::vector<GaitFound>& recordings, std::uint64_t seed);

/// Rows of recordings in which a foot is hidden or held for 40 % of the frames: it is said, and the other
/// foot keeps its events.
void judge_hidden(const std::vector<GaitFound>& recordings, std::uint64_t seed);

}  // namespace kinemark::acceptance
