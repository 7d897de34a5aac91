// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/clock_fit.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/math/statistics.h"

namespace kinemark::stream {
namespace {

constexpr std::size_t kMostPoints = 256, kFewestPoints = 8, kRefit = 16;
constexpr double kStretch_s = 0.25;
constexpr double kFinest_s = 1e-7;  ///< below which no clock of a host is trusted
constexpr int kRounds = 30;

}  // namespace

ClockFit::ClockFit(double rate_hz)
    : rate_hz_(rate_hz), frames_per_stretch_(std::max<std::int64_t>(1, std::llround(kStretch_s * rate_hz))) {
  check(rate_hz > 0.0, "a device has a rate");
  points_.reserve(kMostPoints + 1);
}

void ClockFit::add(std::int64_t frames_ended, std::int64_t host_ns) {
  if (!begun_) {
    begun_ = true;
    first_frame_ = frames_ended;
    first_ns_ = host_ns;
  }
  const std::int64_t frames = frames_ended - first_frame_;
  const double time_s = static_cast<double>(frames) / rate_hz_;
  keep({.stretch = frames / frames_per_stretch_,
        .time_s = time_s,
        .late_s = 1e-9 * static_cast<double>(host_ns - first_ns_) - time_s});
}

bool ClockFit::is_less_late(const Point& a, const Point& b) const {
  return a.late_s - slope_ * a.time_s < b.late_s - slope_ * b.time_s;
}

void ClockFit::keep(const Point& point) {
  if (!points_.empty() && points_.back().stretch == point.stretch) {
    if (is_less_late(point, points_.back())) points_.back() = point;
    return;
  }
  if (points_.size() >= kFewestPoints && points_.size() % kRefit == 0) slope_ = fit().slope;
  if (points_.size() == kMostPoints) halve();
  Point next = point;
  next.stretch = static_cast<std::int64_t>(std::llround(point.time_s * rate_hz_)) / frames_per_stretch_;
  if (!points_.empty() && points_.back().stretch == next.stretch) return keep(next);
  points_.push_back(next);
}

/// Stretches twice as long, of each the less late of its two points.
void ClockFit::halve() {
  frames_per_stretch_ *= 2;
  std::vector<Point> out;
  out.reserve(kMostPoints + 1);
  for (Point point : points_) {
    point.stretch /= 2;
    if (out.empty() || out.back().stretch != point.stretch)
      out.push_back(point);
    else if (is_less_late(point, out.back()))
      out.back() = point;
  }
  points_ = std::move(out);
}

ClockFit::Line ClockFit::fit() const {
  Line line;
  std::vector<double> weights(points_.size(), 1.0), distances(points_.size());
  for (int round = 0; round < kRounds; ++round) {
    double w = 0.0, wt = 0.0, wl = 0.0, wtt = 0.0, wtl = 0.0, wrr = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      w += weights[i];
      wt += weights[i] * points_[i].time_s;
      wl += weights[i] * points_[i].late_s;
    }
    const double mean_t = wt / w, mean_l = wl / w;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double t = points_[i].time_s - mean_t;
      wtt += weights[i] * t * t;
      wtl += weights[i] * t * (points_[i].late_s - mean_l);
    }
    line.slope = wtl / wtt;
    line.offset_s = mean_l - line.slope * mean_t;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      distances[i] = points_[i].late_s - line.offset_s - line.slope * points_[i].time_s;
      wrr += weights[i] * distances[i] * distances[i];
    }
    line.scatter_s = std::max(kFinest_s, std::sqrt(wrr / std::max(w - 2.0, 1.0)));
    line.sd_slope = line.scatter_s / std::sqrt(wtt);
    for (double& d : distances) d = std::abs(d);
    const double scale = std::max(kFinest_s, 3.0 * math::median(distances));
    for (std::size_t i = 0; i < points_.size(); ++i)
      weights[i] = 1.0 / (1.0 + distances[i] * distances[i] / (scale * scale));
  }
  return line;
}

void ClockFit::restart() {
  before_ = rate();
  begun_ = false;
  slope_ = 0.0;
  frames_per_stretch_ = std::max<std::int64_t>(1, std::llround(kStretch_s * rate_hz_));
  points_.clear();
}

std::optional<ClockRate> ClockFit::rate() const {
  if (points_.size() < kFewestPoints) return before_;
  const double span_s = points_.back().time_s - points_.front().time_s;
  if (before_ && before_->span_s > span_s) return before_;
  const auto line = fit();
  ClockRate out{.rate_hz = rate_hz_ / (1.0 + line.slope), .span_s = span_s, .delay_sd_s = line.scatter_s};
  out.ppm_fast = 1e6 * (out.rate_hz / rate_hz_ - 1.0);
  out.sd_ppm = 1e6 * line.sd_slope / ((1.0 + line.slope) * (1.0 + line.slope));
  out.sd_hz = 1e-6 * out.sd_ppm * rate_hz_;
  return out;
}

}  // namespace kinemark::stream
