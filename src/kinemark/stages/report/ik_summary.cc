// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/ik_summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/report/internal/findings.h"

namespace kinemark::report {

namespace {

using data::FrameStatus;
using data::JointMotion;
using data::Trajectories;

/// Sum of squared distances and what goes with it.
struct ErrorSum {
  double squares = 0.0;
  std::int64_t count = 0;
  double largest = -1.0;
  std::int64_t at = -1;  ///< frame or marker of the largest

  void add(double distance, std::int64_t where) {
    squares += distance * distance;
    ++count;
    if (distance > largest) {
      largest = distance;
      at = where;
    }
  }
  [[nodiscard]] double rms() const {
    return count == 0 ? kNaN : std::sqrt(squares / static_cast<double>(count));
  }
  [[nodiscard]] double max() const { return count == 0 ? kNaN : largest; }
};

/// All marker errors of a motion, gone through once in the order in which they lie in memory.
struct Errors {
  std::vector<ErrorSum> of_marker, of_frame;
  ErrorSum all;

  explicit Errors(const JointMotion& motion)
      : of_marker(motion.markers.size()), of_frame(static_cast<std::size_t>(motion.frames())) {
    if (motion.marker_error.empty()) return;
    const double* e = motion.marker_error.data();
    for (std::size_t f = 0; f < of_frame.size(); ++f)
      for (std::size_t m = 0; m < of_marker.size(); ++m, e += 3) {
        const double d = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        if (!std::isfinite(d)) continue;  // not seen
        of_marker[m].add(d, static_cast<std::int64_t>(f));
        of_frame[f].add(d, static_cast<std::int64_t>(m));
        all.add(d, 0);
      }
  }
};

/// rad or m: a coordinate so near to a limit is held by it.
constexpr double kAtLimit = 1e-4;

CoordinateSummary summarize_coordinate(const IkRun& run, const JointMotion& motion, std::int64_t coordinate) {
  const auto j = static_cast<std::size_t>(coordinate);
  CoordinateSummary s{.name = motion.coordinates[j], .is_rotation = motion.is_rotation[j]};
  s.keeps_radians = !motion.keeps_radians.empty() && motion.keeps_radians[j];
  s.locked = std::ranges::find(run.locked_coordinates, s.name) != run.locked_coordinates.end();
  if (!motion.open_frames.empty()) s.open_frames = motion.open_frames[j];
  if (const auto at = std::ranges::find(run.limits, s.name, &CoordinateLimits::coordinate);
      at != run.limits.end() && !s.locked) {
    s.limit_min = at->min;
    s.limit_max = at->max;
  }
  std::vector<double> sds;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const std::size_t i = motion.index(f, coordinate);
    if (!motion.determined.empty() && motion.determined[i] == 0) continue;
    ++s.determined_frames;
    s.min = std::fmin(s.min, motion.q[i]);
    s.max = std::fmax(s.max, motion.q[i]);
    // Without limits both comparisons are false.
    if (motion.q[i] <= s.limit_min + kAtLimit || motion.q[i] >= s.limit_max - kAtLimit) {
      if (s.at_limit_frames == 0) s.first_at_limit = f;
      ++s.at_limit_frames;
    }
    if (!motion.q_sd.empty() && std::isfinite(motion.q_sd[i])) sds.push_back(motion.q_sd[i]);
  }
  s.median_sd = math::upper_median(sds);
  return s;
}

MarkerRow row_of(std::string name, const data::MarkerFit& fit) {
  MarkerRow row{.name = std::move(name)};
  if (const auto marker = std::ranges::find(fit.markers, row.name, &data::FittedMarker::name);
      marker != fit.markers.end()) {
    row.weight = marker->weight;
    row.noise_sd_m = marker->total_sd_m();
    row.rejected_frames = marker->rejected_frames.value_or(0);
    row.used = row.weight > 0.0;
  } else if (const auto left = std::ranges::find(fit.excluded, row.name, &data::ExcludedMarker::name);
             left != fit.excluded.end()) {
    row.weight = 0.0;
    row.why_excluded = left->why;
    row.used = false;
  }
  return row;
}

void summarize_markers(IkSummary& s, const JointMotion& motion, const Trajectories* markers,
                       const Errors& errors) {
  std::int64_t there = 0;
  for (std::size_t m = 0; m < motion.markers.size(); ++m) {
    MarkerRow marker = row_of(motion.markers[m], s.run.fit);
    const ErrorSum& sum = errors.of_marker[m];
    marker.seen_frames = sum.count;
    s.rejected_samples += marker.rejected_frames;
    there += marker.seen_frames + marker.rejected_frames;
    marker.rms_error_m = sum.rms();
    marker.max_error_m = sum.max();
    marker.max_error_frame = sum.at;
    s.markers.push_back(std::move(marker));
  }
  const bool judged = std::ranges::any_of(
      s.run.fit.markers, [](const data::FittedMarker& m) { return m.rejected_frames.has_value(); });
  if (judged && there > 0)
    s.rejected_fraction = static_cast<double>(s.rejected_samples) / static_cast<double>(there);
  s.rms_error_m = errors.all.rms();
  s.max_error_m = errors.all.max();
  const auto add_idle = [&](const std::string& name) {
    if (std::ranges::find(motion.markers, name) != motion.markers.end()) return;
    MarkerRow marker = row_of(name, s.run.fit);
    marker.used = false;
    const std::int64_t column = markers == nullptr ? -1 : markers->find(name);
    for (std::int64_t f = 0; column >= 0 && f < motion.frames(); ++f)
      marker.seen_frames += markers->present(f, column) ? 1 : 0;
    s.markers.push_back(std::move(marker));
  };
  for (const auto& marker : s.run.fit.markers) add_idle(marker.name);
  for (const auto& marker : s.run.fit.excluded) add_idle(marker.name);
}

/// The frames with the largest error; neighbours of one that is taken are the same event and are left out.
void find_worst_frames(IkSummary& s, const JointMotion& motion, const std::vector<ErrorSum>& frames,
                       const SummaryOptions& options) {
  std::vector<std::int64_t> order;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    if (frames[static_cast<std::size_t>(f)].count > 0) order.push_back(f);
  std::ranges::sort(order, [&](std::int64_t a, std::int64_t b) {
    const double x = frames[static_cast<std::size_t>(a)].rms(), y = frames[static_cast<std::size_t>(b)].rms();
    return x != y ? x > y : a < b;
  });

  const auto apart = static_cast<std::int64_t>(std::ceil(options.worst_frame_distance_s * s.time.rate_hz));
  std::vector<bool> near_taken(frames.size(), false);
  for (const std::int64_t f : order) {
    if (std::ssize(s.worst_frames) == options.worst_frames) break;
    if (near_taken[static_cast<std::size_t>(f)]) continue;
    const std::int64_t from = std::max<std::int64_t>(0, f - apart + 1);
    const std::int64_t to = std::min(motion.frames(), std::max(f + 1, f + apart));
    std::fill(near_taken.begin() + from, near_taken.begin() + to, true);
    const ErrorSum& frame = frames[static_cast<std::size_t>(f)];
    s.worst_frames.push_back({.frame = f,
                              .time_s = s.time.time_s(f),
                              .rms_error_m = frame.rms(),
                              .markers_seen = static_cast<int>(frame.count),
                              .marker = motion.markers[static_cast<std::size_t>(frame.at)],
                              .marker_error_m = frame.largest,
                              .status = motion.status.empty() ? FrameStatus::converged
                                                              : motion.status[static_cast<std::size_t>(f)]});
  }
}

}  // namespace

Status SummaryOptions::check() const {
  if (worst_frames < 0)
    return fail(Code::usage, fmt::format("worst_frames is {}; need 0 or more", worst_frames));
  if (!(worst_frame_distance_s >= 0.0) || worst_frame_distance_s > 1e6)
    return fail(Code::usage,
                fmt::format("worst_frame_distance_s is {}; need 0 to 1e6", worst_frame_distance_s));
  return {};
}

Result<IkSummary> summarize(IkRun run, const JointMotion& motion, const Trajectories* markers,
                            const SummaryOptions& options) {
  if (const auto ok = options.check(); !ok) return std::unexpected(ok.error());
  if (const auto ok = motion.validate(); !ok) return std::unexpected(ok.error());
  if (const auto ok = run.fit.validate(); !ok) return std::unexpected(ok.error());
  for (const auto& finding : run.fit.findings)
    if (finding.last_frame >= motion.frames())
      return fail(Code::bad_input, fmt::format("a finding of '{}' names frame {}; the joint motion has {}",
                                               finding.subject, finding.last_frame, motion.frames()));
  if (markers != nullptr) {
    if (markers->state.size() != markers->names.size() * static_cast<std::size_t>(markers->frames()))
      return fail(Code::bad_input, "the report's markers have no state for each frame and marker");
    if (!(markers->time == motion.time))
      return fail(
          Code::bad_input,
          fmt::format("the joint motion has {} frames at {} Hz from {} s, its markers {} at {} Hz from {} s; "
                      "a report needs the same frames",
                      motion.frames(), motion.time.rate_hz, motion.time.t0_s, markers->frames(),
                      markers->time.rate_hz, markers->time.t0_s));
  }
  IkSummary s{.run = std::move(run), .time = motion.time};
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const auto i = static_cast<std::size_t>(f);
    ++s.status_frames[motion.status.empty() ? 0 : static_cast<std::size_t>(motion.status[i])];
  }
  std::int64_t determined = 0, asked = 0;
  for (std::int64_t j = 0; j < motion.size(); ++j) {
    s.coordinates.push_back(summarize_coordinate(s.run, motion, j));
    if (s.coordinates.back().locked) continue;
    determined += s.coordinates.back().determined_frames;
    asked += motion.frames();
  }
  if (asked > 0) s.determined_fraction = static_cast<double>(determined) / static_cast<double>(asked);
  const Errors errors(motion);
  summarize_markers(s, motion, markers, errors);
  find_worst_frames(s, motion, errors.of_frame, options);
  s.notices = internal::find_notices(s, motion);
  s.verdict = std::ranges::any_of(s.notices, [](const Notice& f) { return f.level == Verdict::attention; })
                  ? Verdict::attention
                  : Verdict::good;
  return s;
}

}  // namespace kinemark::report
