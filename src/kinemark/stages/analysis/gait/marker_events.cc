// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/marker_events.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;

constexpr double kUnjudged = 1.5;

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
    if (edge.at_gap) fused.own_sd_s = std::hypot(fused.own_sd_s, kAtEdgeSd_s);
    if (edge.at_end) fused.own_sd_s = std::hypot(fused.own_sd_s, kAtEdgeSd_s);
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
                          .sd_s = std::hypot(fused.common_sd_s, fused.own_sd_s),
                          .source = data::EventSource::kinematics,
                          .method = "markers"});
  }
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
  const auto& paths = smoother.paths();
  out.steps = find_steps(paths, out.ground.velocity);
  add_events(paths, find_edges(paths, out.steps, out.ground.velocity, progress), out);
  auto in_time = out.events;
  std::ranges::stable_sort(in_time, {}, &data::GaitEvent::time_s);
  out.belt = belt_velocity(paths, out.steps, out.ground);
  out.kind = judge_kind(paths, out.ground, out.steps, progress, in_time);
  if (out.ends.doubtful) out.kind.direction = GaitDirection::unknown, out.kind.direction_doubted = true;
  if (out.kind.belt) out.kind.belt_m_per_s = out.belt.velocity.norm();
  const double factor = sd_factor(out.kind.direction);
  for (std::size_t i = 0; i < out.events.size(); ++i) {
    out.fused[i].common_sd_s *= factor, out.fused[i].own_sd_s *= factor;
    out.events[i].sd_s *= factor;
  }
  return out;
}

}  // namespace kinemark::analysis
