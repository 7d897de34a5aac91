// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/marker_events.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;

constexpr double kUnjudged = 1.5;
constexpr int kMostPasses = 3;         // each finds steps on a belt that is more even
constexpr double kScatter_s = 0.007;   // of a detector about the others, from event to event
constexpr double kOfDifference = 0.7;  // of what the feet differ by: what each errs by

// How far the left foot lies to the left of the right one along the way of the pelvis, m; the median over all
// frames.
double left_along_the_way(const GaitPaths& paths, const Progress& progress) {
  std::vector<double> out;
  const auto &left = paths.foot(Side::left), &right = paths.foot(Side::right);
  if (!left.present() || !right.present()) return kNaN;
  for (std::int64_t f = 0; f < paths.frames(); ++f) {
    if (!left.known[at(f)] || !right.known[at(f)]) continue;
    const Eigen::RowVector2d apart = (left.heel.row(f) - right.heel.row(f)).leftCols<2>();
    out.push_back(progress.direction(f, 0) * apart[1] - progress.direction(f, 1) * apart[0]);
  }
  return out.empty() ? kNaN : math::median(out);
}

void add_events(const GaitPaths& paths, const std::vector<SwingEdge>& edges, MarkerEvents& out) {
  const bool running = run_evidence(paths, out.steps, out.ground.velocity).runs();
  for (const auto& edge : edges) {
    if (!edge.seen) {
      ++out.unseen[data::index_of(edge.side)];
      continue;
    }
    auto fused = fuse(edge.after_s, edge.what, running, paths.foot(edge.side).set, 1.0 / paths.rate_hz);
    auto& own_s = fused.error.own_s;
    if (edge.at_gap) own_s = std::hypot(own_s, kAtEdgeSd_s);
    if (edge.at_end) own_s = std::hypot(own_s, kAtEdgeSd_s);
    const double time_s = paths.time_s(edge.frame) + fused.after_s;
    const double half = 0.5 / paths.rate_hz;
    if (time_s < paths.start_s - half ||
        time_s > paths.time_s(static_cast<double>(paths.frames() - 1)) + half)
      continue;  // the recording begins after it, or ends before
    out.edges.push_back(edge);
    out.fused.push_back(fused);
    out.events.push_back({.side = edge.side,
                          .what = edge.what,
                          .time_s = time_s,
                          .sd_s = fused.error.sd_s(),
                          .source = data::EventSource::kinematics,
                          .method = "markers"});
  }
}

// Where the detectors differ from each other in one foot otherwise than in the other, the feet come or go in
// different ways, and no bias is that of both.
void add_foot_errors(MarkerEvents& out) {
  for (const FootEvent what : data::kFootEvents) {
    double squares = 0.0, detectors = 0.0;
    for (std::size_t k = 0; k < kDetectors; ++k) {
      std::array<double, 2> sum{}, count{};
      for (std::size_t i = 0; i < out.events.size(); ++i)
        if (const double apart = out.fused[i].apart_s[k];
            out.events[i].what == what && std::isfinite(apart)) {
          const auto side = data::index_of(out.events[i].side);
          sum[side] += apart, count[side] += 1.0;
        }
      if (!(count[0] > 0.0 && count[1] > 0.0)) continue;
      const double differ = sum[0] / count[0] - sum[1] / count[1];
      squares += std::max(0.0, differ * differ - kScatter_s * kScatter_s * (1.0 / count[0] + 1.0 / count[1]));
      detectors += 1.0;
    }
    if (!(detectors > 0.0)) continue;
    for (std::size_t i = 0; i < out.events.size(); ++i)
      if (auto& error = out.fused[i].error; out.events[i].what == what)
        error.foot_s = std::hypot(error.foot_s, kOfDifference * std::sqrt(squares / detectors));
  }
}

// The detectors of the events of a kind, each less its bias, as they usually lie apart.
DetectorTimes usual_apart(const MarkerEvents& of, FootEvent what) {
  DetectorTimes out{kNaN, kNaN, kNaN, kNaN};
  for (std::size_t k = 0; k < kDetectors; ++k) {
    std::vector<double> apart;
    for (std::size_t i = 0; i < of.events.size(); ++i)
      if (of.events[i].what == what && std::isfinite(of.fused[i].apart_s[k]))
        apart.push_back(of.fused[i].apart_s[k]);
    if (!apart.empty()) out[k] = math::median(apart);
  }
  return out;
}

// How the detectors usually lie apart is somebody's way to walk: what that makes of the time is common to the
// events of a kind. How those of an event lie otherwise is its own.
void add_apart(MarkerEvents& out) {
  for (const FootEvent what : data::kFootEvents) {
    const auto usual = usual_apart(out, what);
    const double common_s = error_of_apart(usual);
    for (std::size_t i = 0; i < out.events.size(); ++i) {
      if (out.events[i].what != what) continue;
      auto apart = out.fused[i].apart_s;
      for (std::size_t k = 0; k < kDetectors; ++k) apart[k] -= usual[k];
      auto& error = out.fused[i].error;
      error.kind_s = std::hypot(error.kind_s, common_s);
      error.own_s = std::hypot(error.own_s, error_of_apart(apart));
    }
  }
}

// Steps, events and the kind of gait on ground that moves evenly.
void judge(const GaitPaths& paths, const Progress& progress, MarkerEvents& out) {
  out.steps = find_steps(paths, out.ground.velocity);
  add_events(paths, find_edges(paths, out.steps, out.ground.velocity, progress), out);
  add_foot_errors(out);
  auto in_time = out.events;
  std::ranges::stable_sort(in_time, {}, &data::GaitEvent::time_s);
  out.belt = belt_velocity(paths, out.steps, out.ground);
  out.kind = judge_kind(paths, out.ground, out.steps, progress, in_time);
}

}  // namespace

double sd_factor(GaitDirection direction) {
  return direction == GaitDirection::backward || direction == GaitDirection::sideways ? kUnjudged : 1.0;
}

Result<MarkerEvents> find_marker_events(GaitSmoother& smoother, const GaitMarkers& which) {
  MarkerEvents out;
  out.ground = ground_velocity(smoother.paths());
  out.steps = find_steps(smoother.paths(), out.ground.velocity);
  if (auto s = smoother.smooth_at(cut_off_of(out.steps.stride_s)); !s) return std::unexpected(s.error());
  out.ground = ground_velocity(smoother.paths());
  auto progress = progress_of(smoother.paths(), out.ground.velocity);
  if (!which.sides_known && left_along_the_way(smoother.paths(), progress) < 0.0) smoother.exchange_sides();
  out.ends = judge_foot_ends(smoother.paths(), progress);
  for (const Side side : data::kBothSides)
    if (out.ends.exchanged[data::index_of(side)]) smoother.exchange_ends(side);
  judge(smoother.paths(), progress, out);
  for (int pass = 0; pass < kMostPasses && out.kind.belt; ++pass) {
    auto pace = belt_pace(smoother.in_laboratory(), out.steps, out.belt.velocity);
    if (!pace.changes() || pace.frame == out.pace.frame) break;
    smoother.set_belt_ahead(
        pace.ahead_of(math::median(pace.m_per_s), smoother.paths().frames(), smoother.paths().rate_hz));
    out = {.ground = ground_velocity(smoother.paths()), .pace = std::move(pace), .ends = out.ends};
    judge(smoother.paths(), progress_of(smoother.paths(), out.ground.velocity), out);
  }
  if (!out.pace.m_per_s.empty()) {
    const auto [least, most] = std::ranges::minmax(out.pace.m_per_s);
    out.kind.belt_least_m_per_s = least, out.kind.belt_most_m_per_s = most;
  }
  if (out.ends.doubtful) out.kind.direction = GaitDirection::unknown, out.kind.direction_doubted = true;
  if (out.kind.belt) out.kind.belt_m_per_s = out.belt.velocity.norm();
  const double factor = sd_factor(out.kind.direction);
  for (std::size_t i = 0; i < out.events.size(); ++i) {
    auto& error = out.fused[i].error;
    error.kind_s *= factor, error.foot_s *= factor, error.own_s *= factor;
  }
  add_apart(out);
  for (std::size_t i = 0; i < out.events.size(); ++i) out.events[i].sd_s = out.fused[i].error.sd_s();
  return out;
}

}  // namespace kinemark::analysis
