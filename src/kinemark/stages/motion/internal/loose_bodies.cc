// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/loose_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr double kOffLine_m = 0.02;  // a point so far from the line through two others tells both sides apart
constexpr double kOnAxis_m = 0.1;    // between two points of a hinge's axis

/// Three of these points do not lie near a line: one pose of their body fits them.
bool fix_a_body(const std::vector<Vector3d>& points) {
  if (points.size() < 3) return false;
  Vector3d along = Vector3d::Zero(), from = points.front();
  for (const auto& a : points)
    for (const auto& b : points)
      if ((b - a).squaredNorm() > along.squaredNorm()) {
        along = b - a;
        from = a;
      }
  const double length = along.norm();
  return std::ranges::any_of(
      points, [&](const Vector3d& p) { return along.cross(p - from).norm() > kOffLine_m * length; });
}

/// A joint that moves, between two groups of bodies; group 0 is the ground.
struct Link {
  std::size_t parent = 0, child = 0;
  std::vector<Vector3d> points;  ///< that both have in common, m
};

/// A model as groups of bodies that do not move against each other, all points where they lie by default.
class Groups {
 public:
  explicit Groups(const Problem& problem) : problem_(problem), w_(problem.model) {
    const auto& model = problem.model;
    model::kinematics(model, w_, model.default_state());
    const auto bodies = model.bodies();
    std::size_t count = 1;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::size_t parent = bodies[b].parent < 0 ? 0 : of_body_[at(bodies[b].parent)];
      const auto moving = moving_columns(bodies[b]);
      of_body_.push_back(moving.empty() ? parent : count++);
      if (!moving.empty())
        links_.push_back({.parent = parent, .child = of_body_[b], .points = points_of(b, moving)});
    }
    for (const auto& marker : model.markers())
      group_.push_back(marker.body < 0 ? 0 : of_body_[at(marker.body)]);
    points_.resize(count);
    fixed_.resize(count);
    carries_.resize(count);
    lost_.resize(count);
  }

  /// 1 for each group that lost a marker and is loose. For each marker: whether it is seen, and ever is.
  std::vector<std::uint8_t> find_loose(const std::vector<std::uint8_t>& seen,
                                       const std::vector<std::uint8_t>& used) {
    std::ranges::fill(carries_, std::uint8_t{0});
    std::ranges::fill(lost_, std::uint8_t{0});
    std::ranges::fill(fixed_, std::uint8_t{0});
    for (auto& points : points_) points.clear();
    for (std::size_t m = 0; m < seen.size(); ++m) {
      if (seen[m] != 0) {
        carries_[group_[m]] = 1;
        points_[group_[m]].push_back(w_.marker.col(static_cast<Eigen::Index>(m)));
      } else if (used[m] != 0) {
        lost_[group_[m]] = 1;
      }
    }
    for (std::size_t l = links_.size(); l-- > 0;)  // parents come before children
      if (carries_[links_[l].child] != 0) carries_[links_[l].parent] = 1;
    fix(0);
    for (std::size_t g = 1; g < points_.size(); ++g)
      if (fixed_[g] == 0 && fix_a_body(points_[g])) fix(g);
    std::vector<std::uint8_t> loose(points_.size(), 0);
    for (std::size_t g = 1; g < loose.size(); ++g)
      loose[g] = lost_[g] != 0 && carries_[g] != 0 && fixed_[g] == 0 ? 1 : 0;
    return loose;
  }

  [[nodiscard]] std::size_t count() const { return points_.size(); }
  [[nodiscard]] std::size_t of_marker(std::size_t m) const { return group_[m]; }

  /// 1 for the speeds of the joints between these groups and those beside them.
  [[nodiscard]] std::vector<std::uint8_t> speeds_at(const std::vector<std::uint8_t>& loose) const {
    const auto& model = problem_.model;
    std::vector<std::uint8_t> speeds(at(model.speed_count()), 0);
    for (std::size_t b = 0; b < of_body_.size(); ++b) {
      const auto& body = model.bodies()[b];
      const bool beside = body.parent >= 0 && loose[of_body_[at(body.parent)]] != 0;
      if (loose[of_body_[b]] == 0 && !beside) continue;
      for (const int c : moving_columns(body)) speeds[at(model.columns()[at(c)].speed)] = 1;
    }
    return speeds;
  }

 private:
  /// Columns of a body's joint whose speeds are not locked.
  [[nodiscard]] std::vector<int> moving_columns(const model::Model::Body& body) const {
    std::vector<int> moving;
    for (int c = body.first_column; c < body.last_column; ++c)
      if (problem_.fixed_speed[at(problem_.model.columns()[at(c)].speed)] == 0) moving.push_back(c);
    return moving;
  }

  /// Points that parent and child have in common: the centre, and another one of the axis of a hinge; none
  /// where the child slides freely.
  [[nodiscard]] std::vector<Vector3d> points_of(std::size_t b, const std::vector<int>& moving) const {
    const auto& body = problem_.model.bodies()[b];
    if (body.free_joint >= 0) return {};
    for (const int c : moving)
      if (w_.column[at(c)].w.norm() < 1e-9) return {};
    const auto child = static_cast<int>(b);
    std::vector<Vector3d> points{model::point_in_world(w_, child, body.body_from_joint.translation)};
    if (moving.size() == 1)
      points.push_back(points.front() + kOnAxis_m * w_.column[at(moving.front())].w.normalized());
    return points;
  }

  /// The pose of a group is known: its joints' centres are, and so may be the groups beside.
  void fix(std::size_t group) {
    fixed_[group] = 1;
    for (const Link& link : links_) {
      if (link.parent != group && link.child != group) continue;
      const auto other = link.parent == group ? link.child : link.parent;
      if (fixed_[other] != 0) continue;
      points_[other].insert(points_[other].end(), link.points.begin(), link.points.end());
      if (fix_a_body(points_[other])) fix(other);
    }
  }

  const Problem& problem_;
  model::Workspace w_;
  std::vector<Link> links_;
  std::vector<std::size_t> of_body_, group_;  ///< group of each body and of each marker
  std::vector<std::vector<Vector3d>> points_;
  std::vector<std::uint8_t> fixed_, carries_, lost_;
};

}  // namespace

LooseFrames find_loose_frames(const Problem& problem, const data::Trajectories& markers, double least_s) {
  const std::size_t M = problem.data_marker.size(), F = at(problem.frames);
  const auto present = [&](std::size_t f, std::size_t m) {
    return markers.present(problem.first_frame + static_cast<std::int64_t>(f), problem.data_marker[m]);
  };
  std::vector<std::uint8_t> used(M, 0), seen(M, 0);
  for (std::size_t f = 0; f < F; ++f)
    for (std::size_t m = 0; m < M; ++m) used[m] = used[m] != 0 || present(f, m) ? 1 : 0;
  Groups groups(problem);
  const std::vector<std::uint8_t> none(groups.count(), 0);
  std::map<std::vector<std::uint8_t>, std::vector<std::uint8_t>> known;  // loose groups by the markers seen
  std::vector<std::vector<std::uint8_t>> loose(F, none);
  for (std::size_t f = 0; f < F; ++f) {
    for (std::size_t m = 0; m < M; ++m) seen[m] = present(f, m) ? 1 : 0;
    if (seen == used) continue;
    const auto [it, is_new] = known.try_emplace(seen);
    if (is_new) it->second = groups.find_loose(seen, used);
    loose[f] = it->second;
  }
  const auto least =
      static_cast<std::size_t>(std::max(1.0, std::round(std::min(least_s * markers.time.rate_hz, 1e6))));
  for (std::size_t g = 0; g < none.size(); ++g)
    for (std::size_t f = 0; f < F; ++f) {
      std::size_t end = f;
      while (end < F && loose[end][g] != 0) ++end;
      for (std::size_t k = f; k < end && end - f < least; ++k) loose[k][g] = 0;
      f = end;
    }
  LooseFrames out;
  out.pattern.assign(F, -1);
  std::map<std::vector<std::uint8_t>, std::int64_t> number_of;
  for (std::size_t f = 0; f < F; ++f) {
    if (loose[f] == none) continue;
    auto key = loose[f];
    for (std::size_t m = 0; m < M; ++m)
      key.push_back(loose[f][groups.of_marker(m)] != 0 && present(f, m) ? 1 : 0);
    const auto [it, is_new] = number_of.try_emplace(std::move(key), std::ssize(out.speeds));
    if (is_new) out.speeds.push_back(groups.speeds_at(loose[f]));
    out.pattern[f] = it->second;
  }
  return out;
}

}  // namespace kinemark::motion::internal
