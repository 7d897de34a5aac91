// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One function per kind of defect; each appends what it finds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/stages/trajectory/screening/screen.h"

namespace kinemark::trajectory::internal {

using data::FindingKind;

/// What a detector found, by index; as_finding() names the markers. The rest is as in data::Finding.
struct Defect {
  FindingKind kind = FindingKind::zero;
  std::int64_t marker = -1;        ///< -1: all markers
  std::int64_t other_marker = -1;  ///< -1: no partner
  std::int64_t first_frame = 0, last_frame = 0;
  std::vector<std::int64_t> frames = {};  ///< those of them that are concerned; empty: all
  double size = kNaN;
  double confidence = kNaN;
  std::string description;
};
using Defects = std::vector<Defect>;

void find_zeros(const data::Trajectories& t, Defects& out);
void find_unit_slips(const data::Trajectories& t, Defects& out);
void find_duplicated_frames(const data::Trajectories& t, Defects& out);
/// `out` holds the duplicated frames: repeats within them are not reported again.
void find_stuck(const data::Trajectories& t, const ScreenOptions& options, Defects& out);
void find_clock_jumps(const TimeBase& clock, std::span<const double> frame_time_s, Defects& out);
/// The same from the markers, for files without recorded times.
void find_leaps(const data::Trajectories& t, Defects& out);
void find_swaps(const data::Trajectories& t, const ScreenOptions& options, Defects& out);
/// `out` holds the swaps: a short one is not a spike.
void find_spikes(const data::Trajectories& t, const ScreenOptions& options, Defects& out);

[[nodiscard]] data::Finding as_finding(Defect defect, const data::Trajectories& t);
/// The samples of a defect become `rejected`: those of both markers of a label swap, none of a clock jump.
void reject(const Defect& defect, data::Trajectories& t);

/// "frame 7" or "frames 7 to 9".
[[nodiscard]] std::string describe_frames(const TimeBase& time, std::int64_t first, std::int64_t last);
/// Confidence that grows with a ratio: one half at `half`, 0.8 at four times that.
[[nodiscard]] double confidence_of(double ratio, double half);
/// Median, the upper one of two; 0 of nothing.
[[nodiscard]] double median_of(std::vector<double> values);
/// Largest rounding step of the three axes of a marker, m.
[[nodiscard]] double rounding_of(const data::Trajectories& t, std::int64_t marker);

}  // namespace kinemark::trajectory::internal
