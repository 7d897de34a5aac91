// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/start_geometry.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/stages/skeleton/articulated/geometry/segment_shape.h"

namespace kinemark::skeleton::articulated {

namespace {

using data::SegmentKind;

// Draws a joint that the motion does not show towards its segments' middle: 1 mm of residual over 0.3 m.
constexpr double kRidge = 1e-5;
constexpr std::int64_t kEnoughForScore = 12;  // frames that show both poses; below, spheres see more

// One segment's markers as a body, where three (a line: two) or more are seen.
struct Body {
  std::vector<int> markers;
  SegmentKind kind = SegmentKind::solid;
  Eigen::Matrix3Xd shape;
  bool whole = false;  // has poses of its own
  std::vector<Matrix3d> rotation;
  std::vector<Vector3d> origin;
  std::vector<double> spread;  // 0: no pose in this frame

  // Local axes along which a joint may lie.
  [[nodiscard]] std::vector<int> axes() const {
    if (kind == SegmentKind::line) return {2};
    return kind == SegmentKind::plane ? std::vector<int>{0, 2} : std::vector<int>{0, 1, 2};
  }
};

Result<Body> make_body(const ChainSamples& samples, std::vector<int> markers, SegmentKind kind,
                       double sigma_m) {
  Body body;
  body.markers = std::move(markers);
  body.kind = kind;
  const std::size_t least = kind == SegmentKind::line ? 2 : 3;
  body.whole = body.markers.size() >= least;
  body.shape = Eigen::Matrix3Xd::Zero(3, body.markers.size());
  if (!body.whole) return body;
  auto shape = segment_shape(samples, body.markers, kind, sigma_m);
  if (!shape) return std::unexpected(shape.error());
  body.shape = std::move(*shape);
  body.rotation.resize(samples.frames);
  body.origin.resize(samples.frames);
  body.spread.assign(samples.frames, 0.0);
  double most = 0.0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    double spread = 0.0;
    if (rigid_pose(samples, f, body.markers, body.shape, kind, body.rotation[f], body.origin[f], spread)) {
      body.spread[f] = spread;
      most = std::max(most, spread);
    }
  }
  if (!(most > 0.0))
    return fail(Code::bad_input, "a segment shows no frame with enough markers for its pose");
  for (double& s : body.spread) s /= most;
  return body;
}

// Positions of the joint in both bodies' axes.
struct Joint {
  Vector3d in_parent = Vector3d::Zero(), in_child = Vector3d::Zero();
};

Result<Joint> score(const ChainSamples& samples, const Body& a, const Body& b, std::int64_t least) {
  const std::vector<int> axes_a = a.axes();
  const std::vector<int> axes_b = b.axes();
  const Eigen::Index n = static_cast<Eigen::Index>(axes_a.size() + axes_b.size());
  Eigen::MatrixXd normal = kRidge * Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd row(3, n);
  std::int64_t used = 0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    const double weight = std::min(a.spread[f], b.spread[f]);
    if (weight <= 0.0) continue;
    Eigen::Index c = 0;
    for (const int axis : axes_a) row.col(c++) = a.rotation[f].col(axis);
    for (const int axis : axes_b) row.col(c++) = -b.rotation[f].col(axis);
    normal += weight * row.transpose() * row;
    right += weight * row.transpose() * (b.origin[f] - a.origin[f]);
    ++used;
  }
  if (used < least)
    return fail(Code::bad_input,
                "fewer than three frames show both segments of a joint well enough for their poses");
  const Eigen::VectorXd p = normal.ldlt().solve(right);
  Joint joint;
  Eigen::Index c = 0;
  for (const int axis : axes_a) joint.in_parent[axis] = p[c++];
  for (const int axis : axes_b) joint.in_child[axis] = p[c++];
  return joint;
}

// Centre of the spheres that the markers of `b` describe in the axes of `a`: |y - p|^2 = r^2 is linear in p
// and r^2 - |p|^2, one unknown for each marker.
Result<Vector3d> sphere_centre(const ChainSamples& samples, const Body& a, const Body& b) {
  const Eigen::Index n = 3 + static_cast<Eigen::Index>(b.markers.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
  std::int64_t used = 0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    if (a.spread[f] <= 0.0) continue;
    for (std::size_t i = 0; i < b.markers.size(); ++i) {
      if (!samples.seen(f, b.markers[i])) continue;
      const Vector3d y = a.rotation[f].transpose() *
                         (Eigen::Map<const Vector3d>(samples.frame(f) + 3 * b.markers[i]) - a.origin[f]);
      row.setZero();
      row.head<3>() = 2.0 * y;
      row[3 + static_cast<Eigen::Index>(i)] = 1.0;
      normal += a.spread[f] * row * row.transpose();
      right += a.spread[f] * y.squaredNorm() * row;
      ++used;
    }
  }
  if (used < 4) return fail(Code::bad_input, "fewer than four samples show a joint's two segments together");
  normal.topLeftCorner<3, 3>().diagonal().array() += 1e-9 * normal.topLeftCorner<3, 3>().trace();
  return Vector3d(normal.ldlt().solve(right).head<3>());
}

// Both bodies have poses, but perhaps in few of the same frames: then each body sees the other's markers on
// spheres.
Result<Joint> start_joint(const ChainSamples& samples, const Body& a, const Body& b) {
  if (auto joint = score(samples, a, b, kEnoughForScore); joint) return joint;
  const bool solid = a.kind != SegmentKind::line && b.kind != SegmentKind::line;
  if (solid) {
    const auto in_a = sphere_centre(samples, a, b), in_b = sphere_centre(samples, b, a);
    if (in_a && in_b) return Joint{.in_parent = *in_a, .in_child = *in_b};
  }
  return score(samples, a, b, 3);
}

// One or two markers about a joint whose position is known in the other body: distances give a planar shape.
void shape_about_joint(const ChainSamples& samples, const Body& a, const Vector3d& p, Body& b) {
  std::vector<double> sum(b.markers.size(), 0.0);
  std::vector<double> count(b.markers.size(), 0.0);
  double dot = 0.0;
  double both = 0.0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    if (a.spread[f] <= 0.0) continue;
    const Vector3d J = a.origin[f] + a.rotation[f] * p;
    std::vector<Vector3d> arm(b.markers.size(), Vector3d::Zero());
    for (std::size_t i = 0; i < b.markers.size(); ++i) {
      if (!samples.seen(f, b.markers[i])) continue;
      arm[i] = Eigen::Map<const Vector3d>(samples.frame(f) + 3 * b.markers[i]) - J;
      sum[i] += arm[i].squaredNorm();
      count[i] += 1.0;
    }
    if (b.markers.size() == 2 && !arm[0].isZero() && !arm[1].isZero()) {
      dot += arm[0].dot(arm[1]);
      both += 1.0;
    }
  }
  for (std::size_t i = 0; i < b.markers.size(); ++i) {
    const double length = std::sqrt(sum[i] / std::max(count[i], 1.0));
    const double first = b.shape(2, 0);
    if (i == 0 || b.kind == SegmentKind::line || both == 0.0 || first <= 0.0) {
      b.shape(2, i) = length;
      continue;
    }
    const double along = std::clamp(dot / both / first, -length, length);
    b.shape(2, i) = along;
    b.shape(0, i) = std::sqrt(std::max(length * length - along * along, 0.0));
  }
}

}  // namespace

Result<Chain> start_geometry(const ChainSamples& samples, const ChainLayout& layout,
                             const std::vector<SegmentKind>& kind, double sigma_m) {
  std::vector<Body> bodies;
  for (int s = 0; s < layout.segments(); ++s) {
    auto body = make_body(samples, layout.markers_of(s), kind[s], sigma_m);
    if (!body) return std::unexpected(body.error());
    bodies.push_back(std::move(*body));
  }
  std::vector<Joint> joints(layout.joints());
  for (int j = 0; j < layout.joints(); ++j) {
    Body& parent = bodies[layout.parent[j]];
    Body& child = bodies[j + 1];
    if (parent.whole && child.whole) {
      auto joint = start_joint(samples, parent, child);
      if (!joint) return std::unexpected(joint.error());
      joints[j] = *joint;
      continue;
    }
    // The poor one must be an end of the chain, beside one with full poses.
    Body& poor = parent.whole ? child : parent;
    const Body& full = parent.whole ? parent : child;
    const int poor_segment = parent.whole ? j + 1 : layout.parent[j];
    const auto touches =
        std::count(layout.parent.begin(), layout.parent.end(), poor_segment) + (poor_segment > 0 ? 1 : 0);
    if (!full.whole || full.kind == SegmentKind::line || touches > 1 || poor.markers.empty()) {
      return fail(Code::bad_input, "segments " + std::to_string(layout.parent[j]) + " and " +
                                       std::to_string(j + 1) +
                                       " carry too few markers between them to find their joint: three on "
                                       "one of them and one on the other are needed");
    }
    auto centre = sphere_centre(samples, full, poor);
    if (!centre) return std::unexpected(centre.error());
    shape_about_joint(samples, full, *centre, poor);
    (parent.whole ? joints[j].in_parent : joints[j].in_child) = *centre;
  }
  Chain chain(layout, kind);
  for (int s = 0; s < layout.segments(); ++s) {
    const Vector3d origin = s == 0 ? joints[0].in_parent : joints[s - 1].in_child;
    for (std::size_t i = 0; i < bodies[s].markers.size(); ++i) {
      const Vector3d m = bodies[s].shape.col(i) - origin;
      if (m.allFinite()) chain.marker.col(bodies[s].markers[i]) = m;
    }
    for (int j = 1; j < layout.joints(); ++j) {
      if (layout.parent[j] == s) chain.joint.col(j) = joints[j].in_parent - origin;
    }
  }
  make_canonical(chain);
  return chain;
}

}  // namespace kinemark::skeleton::articulated
