// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_facts.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/path/rhythm.h"

namespace kinemark::analysis {
namespace {

constexpr double kAround_s = 0.05;       // kept before onset and behind the end
constexpr double kRegularCycles = 0.25;  // largest SD of cycles over their mean
constexpr std::int64_t kLeastCycles = 2;
constexpr double kLeastTurns = 0.6;  // of an arc: a shorter one says little of its ellipse
constexpr double kComesBack = 0.25;  // largest way of a cycle's trend over the extent without it

// The samples from onset to end and those around them; all where there is no onset or end.
PathSamples moving_part(const PathSamples& path, const MovementWindow& window) {
  if (std::isnan(window.onset_s) || std::isnan(window.end_s)) return path;
  const auto sample = [&](double s) { return static_cast<std::int64_t>(std::floor(s * path.rate_hz)); };
  const std::int64_t first = std::max<std::int64_t>(0, sample(window.onset_s - kAround_s));
  const std::int64_t count = std::min(path.count(), sample(window.end_s + kAround_s) + 1) - first;
  return {.rate_hz = path.rate_hz,
          .x = path.x.middleRows(first, count),
          .v = path.v.middleRows(first, count),
          .a = path.a.middleRows(first, count),
          .j = path.j.middleRows(first, count)};
}

// Way of the straight trend in a time, over the extent of the path without the trend.
double drift_of(const PathSamples& path, double time_s) {
  const PathMatrix level = without_trend(path.x);
  const PathMatrix trend = path.x - level;
  const double speed = (trend.row(path.count() - 1) - trend.row(0)).norm() * path.rate_hz /
                       static_cast<double>(std::max<std::int64_t>(1, path.count() - 1));
  return speed * time_s / (level.colwise().maxCoeff() - level.colwise().minCoeff()).norm();
}

// Where the periodogram is largest.
double dominant_peak(const PathSamples& path) {
  constexpr double kLowest_hz = 0.3;
  const double low = peak_frequency(periodogram_of(path.x, path.rate_hz, kLowHz), kLowest_hz);
  // Where a higher one may have more, all of them.
  return std::isnan(low) ? peak_frequency(periodogram_of(path.x, path.rate_hz), kLowest_hz) : low;
}

// What `make` makes, made once.
template <class Value, class Make>
const Value& once(std::optional<Value>& value, const Make& make) {
  if (!value) value = make();
  return *value;
}

}  // namespace

bool hardly_changes(const Eigen::VectorXd& values) {
  const std::span<const double> all(values.data(), static_cast<std::size_t>(values.size()));
  return math::quantile(all, 0.95) - math::quantile(all, 0.05) < 0.1 * math::median(all);
}

PathFrame recognise(const PathSamples& path) {
  PathFrame out;
  const Eigen::VectorXd speed = speed_of(path);
  const double peak = speed.maxCoeff();
  out.share_at_rest =
      static_cast<double>((speed.array() <= kMovingShare * peak).count()) / static_cast<double>(path.count());
  out.steady = hardly_changes(speed);
  out.cycle_axis = detrended_axis(path.x);
  out.harmonics = harmonic_form(path.x, path.rate_hz, dominant_peak(path));
  const auto window = movement_window(path, speed);
  const double last_s = static_cast<double>(path.count() - 1) / path.rate_hz;
  // A sample's tolerance, so that a rest of just that length counts.
  const double hold_s = kMovingHold_s - 1.0 / path.rate_hz;
  out.discrete = window.onset_s >= hold_s && last_s - window.end_s >= hold_s;
  if (!out.discrete) {
    const auto cycles = cycles_along(path.x, out.cycle_axis, path.rate_hz);
    out.periodic = cycles.count >= kLeastCycles && cycles.sd_s < kRegularCycles * cycles.mean_s &&
                   likeness_after(path.v, path.rate_hz, cycles.mean_s) >= kPeriodicLikeness;
    out.closed = out.periodic && drift_of(path, cycles.mean_s) < kComesBack;
  }
  out.turning = turning_of(path.x);
  out.round =
      out.turning.one_way && out.turning.turns >= kLeastTurns && (out.closed || out.turning.on_an_ellipse);
  out.whole = out.closed || (out.round && out.turning.turns >= 1.0);
  return out;
}

const OuterSamples& NearPath::outer() const {
  return once(outer_, [this] { return outer_samples(x_); });
}

PathFacts::PathFacts(const PathSamples& samples, const PathFrame& settled, const NearPath* near_path)
    : path(samples),
      frame(settled),
      near(near_path),
      speed(speed_of(samples)),
      window(movement_window(samples, speed)) {
  if (settled.discrete) part_ = moving_part(samples, window);
}

const Eigen::VectorXd& PathFacts::moving_speed() const {
  if (!part_) return speed;
  return once(moving_speed_, [this] { return speed_of(*part_); });
}
const PrincipalAxes& PathFacts::principal() const {
  return once(principal_, [this] { return principal_axes(path.x); });
}
const PathMatrix& PathFacts::along() const {
  return once(along_, [this] { return along_axes(path.x, principal()); });
}
const Cycles& PathFacts::cycles() const {
  return once(cycles_, [this] { return cycles_along(path.x, frame.cycle_axis, path.rate_hz); });
}
const EllipseAxes& PathFacts::ellipse() const {
  return once(ellipse_,
              [this] { return frame.closed || frame.round ? ellipse_axes(along()) : EllipseAxes{}; });
}
double PathFacts::whole_end() const {
  if (frame.round) return whole_turns_end(path.x, frame.turning);
  const double last = static_cast<double>(path.count() - 1);
  if (!frame.closed) return last;
  return std::min(last, static_cast<double>(cycles().count) * cycles().mean_s * path.rate_hz);
}
const Diameters& PathFacts::distances() const {
  return once(distances_, [this] { return diameters(path.x); });
}
const CurvatureTerms& PathFacts::curvature_terms() const {
  return once(curvature_terms_, [this] { return curvature_terms_of(path); });
}
const Eigen::Vector3d& PathFacts::box() const {
  return once(box_, [this] {
    return near == nullptr ? smallest_box(path.x, principal())
                           : smallest_box(path.x, principal(), near->outer(), near->x());
  });
}
const Periodogram& PathFacts::periodogram() const {
  return once(periodogram_, [this] { return periodogram_of(path.x, path.rate_hz, kLowHz); });
}
const HarmonicFit& PathFacts::harmonics() const {
  return once(harmonics_, [this] { return fit_harmonics(path.x, path.rate_hz, frame.harmonics); });
}

}  // namespace kinemark::analysis
