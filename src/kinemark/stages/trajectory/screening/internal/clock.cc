// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/trajectory/screening/internal/defects.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr std::size_t kMostSingle = 10;

/// One step of all markers that is as long as several.
struct Leap {
  std::int64_t frame = 0;
  double times = 0.0;
  int seen = 0;
};

/// A clock that loses frames all the time is reported as one defect; most often the recording was resampled
/// by leaving frames out.
Defect describe_many(const std::vector<Leap>& leaps, const data::Trajectories& t) {
  std::vector<double> spacing;
  std::vector<double> times;
  for (std::size_t i = 0; i < leaps.size(); ++i) {
    times.push_back(leaps[i].times);
    if (i > 0) spacing.push_back(static_cast<double>(leaps[i].frame - leaps[i - 1].frame));
  }
  const double usual = median_of(spacing), far = median_of(times);
  const auto same = static_cast<std::size_t>(std::ranges::count(spacing, usual));
  std::string how = fmt::format("typically {:.0f} frames apart", usual);
  if (2 * same >= spacing.size() && std::round(far) == 2.0)  // one frame at a time
    how =
        fmt::format("most often every {:.0f} frames: {:.6g} Hz from which every {:.0f}th frame was left out?",
                    usual, t.time.rate_hz * (usual + 1.0) / usual, usual + 1.0);
  return {
      .kind = FindingKind::clock_jump,
      .first_frame = leaps.front().frame,
      .last_frame = leaps.back().frame,
      .confidence = 0.95,
      .description = fmt::format(
          "at {} instants between frames {} and {} all markers that are seen go {:.2f} times as far as in "
          "the frames beside, {}",
          leaps.size(), t.time.number(leaps.front().frame), t.time.number(leaps.back().frame), far, how)};
}

}  // namespace

void find_clock_jumps(const TimeBase& clock, std::span<const double> time_s, Defects& out) {
  std::vector<double> ticks;
  for (std::size_t f = 1; f < time_s.size(); ++f)
    if (std::isfinite(time_s[f] - time_s[f - 1])) ticks.push_back(time_s[f] - time_s[f - 1]);
  const double usual = median_of(ticks);
  if (!(usual > 0.0)) {
    if (time_s.size() > 1)
      out.push_back({.kind = FindingKind::clock_jump,
                     .first_frame = 0,
                     .last_frame = static_cast<std::int64_t>(time_s.size()) - 1,
                     .confidence = 0.999,
                     .description = ticks.empty()
                                        ? "no two frames that follow each other have times: this is no clock"
                                        : "the times of most frames do not increase: this is no clock"});
    return;
  }
  for (std::size_t f = 0; f < time_s.size(); ++f) {
    const auto frame = static_cast<std::int64_t>(f);
    const double tick = f == 0 ? usual : time_s[f] - time_s[f - 1];
    const double off = std::abs(tick / usual - 1.0);
    if (std::isfinite(time_s[f]) && (!std::isfinite(tick) || off <= 0.5)) continue;
    std::string what = fmt::format("{:.6g} s after the one before, {:.3g} times the usual {:.6g} s", tick,
                                   tick / usual, usual);
    if (!std::isfinite(time_s[f])) what = "at a time that is not a number";
    out.push_back({.kind = FindingKind::clock_jump,
                   .first_frame = frame,
                   .last_frame = frame,
                   .size = tick / usual - 1.0,
                   .confidence = 0.999,
                   .description = fmt::format("frame {} is {}", clock.number(frame), what)});
  }
}

// A lost frame makes one step of all markers a whole multiple of the steps before and after it, in their
// direction. A body does not do that: it would have to start and stop in all its parts within one frame.
void find_leaps(const data::Trajectories& t, Defects& out) {
  constexpr int kLeastMarkers = 3;
  std::vector<Leap> leaps;
  for (std::int64_t f = 2; f + 1 < t.frames(); ++f) {
    double along = 0.0;
    double speed = 0.0;
    double leap = 0.0;
    double curvature = 0.0;
    int seen = 0;
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      if (!t.present(f - 2, m) || !t.present(f - 1, m) || !t.present(f, m) || !t.present(f + 1, m)) continue;
      const Eigen::Vector3d before = t.x(f - 1, m) - t.x(f - 2, m);
      const Eigen::Vector3d step = t.x(f, m) - t.x(f - 1, m);
      const Eigen::Vector3d after = t.x(f + 1, m) - t.x(f, m);
      const Eigen::Vector3d mean = 0.5 * (before + after);
      along += step.dot(mean);
      speed += mean.squaredNorm();
      leap += step.squaredNorm();
      curvature += (after - before).squaredNorm();
      ++seen;
    }
    if (seen < kLeastMarkers || !(speed > seen * 1e-8)) continue;  // 0.1 mm per frame
    const double times = along / speed;
    const double unexplained = std::max(0.0, leap - times * along) / leap;
    const bool multiple = times > 1.8 && std::abs(times - std::round(times)) < 0.15;
    const bool even = unexplained < 0.02 && curvature < 0.25 * speed;
    if (!multiple || !even || !std::isfinite(leap)) continue;
    leaps.push_back({f, times, seen});
  }
  if (leaps.size() > kMostSingle) {
    out.push_back(describe_many(leaps, t));
    return;
  }
  for (const Leap& l : leaps)
    out.push_back({.kind = FindingKind::clock_jump,
                   .first_frame = l.frame,
                   .last_frame = l.frame,
                   .size = std::round(l.times) - 1.0,
                   .confidence = l.seen < 6 ? 0.7 : 0.9,
                   .description = fmt::format(
                       "between frames {} and {} all {} markers that are seen go {:.2f} times as far "
                       "as in the frames beside: {:.0f} lost there",
                       t.time.number(l.frame - 1), t.time.number(l.frame), l.seen, l.times,
                       std::round(l.times) - 1.0)});
}

}  // namespace kinemark::trajectory::internal
