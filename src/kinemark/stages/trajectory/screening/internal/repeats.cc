// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Repeated values: zeros for "not seen", a last value held, whole frames repeated.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/trajectory/screening/internal/defects.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Trajectories;

constexpr double kHarmless = 2e-5;   // m per frame: a body at rest, or an encoder
constexpr double kAtOrigin = 0.005;  // m: a marker that near before and after may have passed through

bool repeats(const Trajectories& t, std::int64_t frame, std::int64_t marker) {
  return frame > 0 && t.present(frame, marker) && t.present(frame - 1, marker) &&
         t.x(frame, marker) == t.x(frame - 1, marker);
}

/// Lengths of steps between neighbouring frames of [first, last] that are no repeats.
std::vector<double> steps(const Trajectories& t, std::int64_t marker, std::int64_t first, std::int64_t last) {
  std::vector<double> lengths;
  for (std::int64_t f = std::max<std::int64_t>(1, first); f <= std::min(last, t.frames() - 1); ++f)
    if (t.present(f, marker) && t.present(f - 1, marker) && !repeats(t, f, marker))
      lengths.push_back((t.x(f, marker) - t.x(f - 1, marker)).norm());
  return lengths;
}

bool is_zero(const Trajectories& t, std::int64_t frame, std::int64_t marker) {
  return t.present(frame, marker) && t.x(frame, marker).isZero(0.0);
}

/// Distance from the origin of the nearest sample that is not zero, going from `frame` by `way`; none:
/// infinite.
double distance_beside(const Trajectories& t, std::int64_t marker, std::int64_t frame, std::int64_t way) {
  for (; frame >= 0 && frame < t.frames(); frame += way)
    if (t.present(frame, marker) && !is_zero(t, frame, marker)) return t.x(frame, marker).norm();
  return HUGE_VAL;
}

/// True when real frames come at one regular distance of two or more: a stream interpolated by holding, which
/// detect_upsampling() names; no slip.
bool held_regularly(const std::vector<char>& whole) {
  std::vector<std::size_t> count(16, 0);  // of distances between frames that are no repeats; the last: longer
  std::size_t real = 0;
  std::size_t distance = 1;
  for (std::size_t f = 1; f < whole.size(); ++f, ++distance) {
    if (whole[f] != 0) continue;
    ++count[std::min(distance, count.size() - 1)];
    ++real;
    distance = 0;
  }
  return real > 4 && 10 * *std::max_element(count.begin() + 2, count.end() - 1) > 9 * real;
}

}  // namespace

void find_zeros(const Trajectories& t, Defects& out) {
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    for (std::int64_t f = 0; f < t.frames(); ++f) {
      if (!is_zero(t, f, m)) continue;
      const std::int64_t first = f;
      while (f + 1 < t.frames() && is_zero(t, f + 1, m)) ++f;
      const double nearest = std::min(distance_beside(t, m, first, -1), distance_beside(t, m, f, 1));
      if (nearest < kAtOrigin) continue;
      const std::string beside =
          std::isfinite(nearest) ? fmt::format("the nearest sample is {:.0f} mm away from it", 1e3 * nearest)
                                 : std::string("it is never seen anywhere else");
      out.push_back({.kind = FindingKind::zero,
                     .marker = m,
                     .first_frame = first,
                     .last_frame = f,
                     .confidence = confidence_of(nearest / kAtOrigin, 0.5),
                     .description = fmt::format(
                         "marker '{}' is exactly at the origin in {}; {}: zero means not seen",
                         t.names[static_cast<std::size_t>(m)], describe_frames(t.time, first, f), beside)});
    }
  }
}

void find_duplicated_frames(const Trajectories& t, Defects& out) {
  const auto frames = static_cast<std::size_t>(t.frames());
  const auto markers = static_cast<std::size_t>(t.markers());
  std::vector<char> whole(frames, 0);  // every marker repeats
  std::size_t wholes = 0;
  for (std::size_t f = 1; f < frames; ++f) {
    bool all = true;
    int seen = 0;
    for (std::size_t m = 0; m < markers && all; ++m) {
      const auto frame = static_cast<std::int64_t>(f);
      const auto marker = static_cast<std::int64_t>(m);
      all = t.present(frame, marker) == t.present(frame - 1, marker) &&
            (!t.present(frame, marker) || repeats(t, frame, marker));
      seen += t.present(frame, marker) ? 1 : 0;
    }
    whole[f] = all && seen > 0 ? 1 : 0;
    wholes += all && seen > 0 ? 1U : 0U;
  }
  if (wholes == 0 || held_regularly(whole)) return;
  // How often each marker repeats by itself: coarse rounding makes single ones repeat all the time.
  std::vector<double> log_chance(markers, 0.0);
  std::vector<double> rounding(markers, 0.0);
  for (std::size_t m = 0; m < markers; ++m) {
    std::size_t alone = 1;
    for (std::size_t f = 1; f < frames; ++f)
      alone +=
          whole[f] == 0 && repeats(t, static_cast<std::int64_t>(f), static_cast<std::int64_t>(m)) ? 1U : 0U;
    const std::size_t others = frames - wholes;
    log_chance[m] = std::log(static_cast<double>(std::min(alone, others)) / static_cast<double>(others));
    rounding[m] = rounding_of(t, static_cast<std::int64_t>(m));
  }
  for (std::int64_t f = 1; f < t.frames(); ++f) {
    if (whole[static_cast<std::size_t>(f)] == 0) continue;
    const std::int64_t first = f;
    while (f + 1 < t.frames() && whole[static_cast<std::size_t>(f + 1)] != 0) ++f;
    double log_all = std::log(static_cast<double>(frames));
    int moving = 0;
    int seen = 0;
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      if (!t.present(f, m)) continue;
      ++seen;
      log_all += log_chance[static_cast<std::size_t>(m)];
      // It must have moved right before and after: bodies and models that rest come to rest.
      const double beside = median_of(steps(t, m, first - 5, f + 6));
      const double before = first == 1 ? HUGE_VAL : median_of(steps(t, m, first - 1, first - 1));
      const double after = median_of(steps(t, m, f + 1, f + 1));
      const double least = std::max(0.3 * beside, 4.0 * rounding[static_cast<std::size_t>(m)]);
      moving += before > least && (after > least || f + 1 == t.frames()) ? 1 : 0;
    }
    if (log_all > std::log(1e-4) || 2 * moving < seen) continue;
    out.push_back({.kind = FindingKind::duplicated_frame,
                   .first_frame = first,
                   .last_frame = f,
                   .confidence = confidence_of(-log_all, 2.0),
                   .description = fmt::format(
                       "all {} markers that are seen repeat frame {} in {}, digit by digit, while "
                       "{} of them move right before and after",
                       seen, t.time.number(first - 1), describe_frames(t.time, first, f), moving)});
  }
}

void find_stuck(const Trajectories& t, const ScreenOptions& options, Defects& out) {
  std::vector<char> duplicated(static_cast<std::size_t>(t.frames()), 0);
  for (const Defect& d : out)
    for (std::int64_t f = d.first_frame; f <= d.last_frame; ++f) duplicated[static_cast<std::size_t>(f)] = 1;
  const double held =
      std::min(std::ceil(options.min_stuck_s * t.time.rate_hz), static_cast<double>(t.frames()) + 1.0);
  const auto shortest = std::max<std::int64_t>(8, static_cast<std::int64_t>(held));
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    std::vector<std::pair<std::int64_t, std::int64_t>> runs;  // frames that hold one value
    std::vector<double> lengths;
    for (std::int64_t f = 0; f < t.frames(); ++f) {
      if (!t.present(f, m)) continue;
      const std::int64_t first = f;
      std::int64_t repeated = 1;
      while (f + 1 < t.frames() && repeats(t, f + 1, m)) {
        ++f;
        repeated += duplicated[static_cast<std::size_t>(f)] != 0 ? 0 : 1;
      }
      lengths.push_back(static_cast<double>(repeated));
      if (repeated >= shortest) runs.emplace_back(first, f);
    }
    if (runs.empty()) continue;
    // Usual runs of the marker: an upsampled stream by holding has runs of its factor, a coarse one at rest
    // has long ones.
    const double usual = math::nth_smallest(lengths, lengths.size() * 9 / 10);
    const double rounding = rounding_of(t, m);
    for (const auto& [first, last] : runs) {
      const auto length = static_cast<double>(last - first + 1);
      const bool rare = 20 * runs.size() <= lengths.size();
      const std::int64_t reach = std::max<std::int64_t>(10, last - first + 1);
      const std::vector<double> beside = steps(t, m, first - reach, last + 1 + reach);
      const double step = median_of(beside);
      // Held, as opposed to at rest: normal steps precede and follow.
      const std::vector<double> in = steps(t, m, first, first);
      const std::vector<double> away = steps(t, m, last + 1, last + 1);
      const double least = std::max(0.3 * step, 4.0 * rounding);
      const bool abrupt =
          (in.empty() || in[0] > least) && (away.empty() || away[0] > least) && !(in.empty() && away.empty());
      if (!rare || !abrupt || length < 5.0 * usual || beside.size() < 5 || step < kHarmless) continue;
      const double ratio = length * step / rounding;
      out.push_back({.kind = FindingKind::stuck,
                     .marker = m,
                     .first_frame = first,
                     .last_frame = last,
                     .confidence = confidence_of(ratio, 8.0),
                     .description = fmt::format(
                         "marker '{}' holds one value, digit by digit, in {}; beside them it moves "
                         "{:.3f} mm per frame in steps of {:.4f} mm",
                         t.names[static_cast<std::size_t>(m)], describe_frames(t.time, first, last),
                         1e3 * step, 1e3 * rounding)});
    }
  }
}

}  // namespace kinemark::trajectory::internal
