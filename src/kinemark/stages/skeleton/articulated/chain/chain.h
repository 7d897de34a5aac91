// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A tree of rigid segments that share joints: its geometry, which is the same in all frames, and a pose.
// Theory: docs/theory/joint-centres.md
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/skeleton.h"

namespace kinemark::skeleton::articulated {

/// A joint that turns about one axis: unit vectors in the axes of its parent and of its child.
struct HingeAxis {
  int joint = 0;
  Eigen::Vector3d in_parent = Eigen::Vector3d::Zero(), in_child = Eigen::Vector3d::Zero();
};

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Markers of a chain through time, in the order of the chain: F x K x 3, m; NaN where not seen.
struct ChainSamples {
  std::int64_t frames = 0;
  int markers = 0;
  Array<double> x;

  [[nodiscard]] const double* frame(std::int64_t f) const { return x.data() + 3 * f * markers; }
  /// A sample is seen when its first coordinate is a number.
  [[nodiscard]] bool seen(std::int64_t f, int marker) const {
    const double value = frame(f)[3 * marker];
    return value == value;
  }
};

/// Which segment carries which marker and which joints join them: S segments, S - 1 joints, K markers. Joint
/// j is the upper joint of segment j + 1 and joins it to segment parent[j] <= j; parent[0] = 0. A serial
/// chain has parent[j] = j.
struct ChainLayout {
  std::vector<int> parent;             ///< S - 1, one joint at least
  std::vector<int> segment_of_marker;  ///< K

  [[nodiscard]] int segments() const { return static_cast<int>(parent.size()) + 1; }
  [[nodiscard]] int joints() const { return static_cast<int>(parent.size()); }
  [[nodiscard]] int markers() const { return static_cast<int>(segment_of_marker.size()); }
  /// Markers of a segment.
  [[nodiscard]] std::vector<int> markers_of(int segment) const;
};

/// Position of joint 0 and rotation of every segment: x = joint + rotation * x_in_segment.
struct ChainPose {
  Vector3d joint0 = Vector3d::Zero();  ///< m, in world
  std::vector<Matrix3d> rotation;      ///< S, world from segment
};

/// Geometry. A segment's axes start at its upper joint (segment 0: at joint 0). Marker k of segment s is at
/// x_k = o_s + R_s m_k, joint j at o_p + R_p l_j, p = parent[j], l_0 = 0. The local coordinates in use are z
/// (line), x and z (plane) or all three (solid): these of all markers, then those of joints 1 to S - 2, are
/// the geometry parameters. Rotating a segment's axes changes no prediction: a solid has three such gauge
/// freedoms, a plane one.
struct Chain {
  ChainLayout layout;
  std::vector<data::SegmentKind> kind;  ///< S
  Eigen::Matrix3Xd marker;              ///< K columns: m_k, m
  Eigen::Matrix3Xd joint;               ///< S - 1 columns: l_j in the axes of its parent, m; column 0 is zero

  /// One parameter: coordinate `axis` of marker `marker`, or of joint `joint` when marker is -1.
  struct GeometryParameter {
    int marker = -1, joint = -1, axis = 0;
    int segment = 0;  ///< in whose axes
  };

  Chain() = default;
  Chain(ChainLayout layout, std::vector<data::SegmentKind> kind);

  [[nodiscard]] int segments() const { return layout.segments(); }
  [[nodiscard]] int joints() const { return layout.joints(); }
  [[nodiscard]] int markers() const { return layout.markers(); }

  /// Parameters of a frame: joint 0 (3), then each segment's rotation vector (line 2, else 3) in its own
  /// axes, multiplied from the right.
  [[nodiscard]] int frame_parameters() const { return frame_parameters_; }
  [[nodiscard]] int rotation_offset(int segment) const { return rotation_offset_[segment]; }
  [[nodiscard]] int rotation_size(int segment) const {
    return kind[segment] == data::SegmentKind::line ? 2 : 3;
  }
  [[nodiscard]] const std::vector<GeometryParameter>& geometry_parameters() const {
    return geometry_parameters_;
  }
  /// Joints between joint 0, which is left out, and the origin of a segment: o_s = joint 0 + the sum of R l
  /// over them.
  [[nodiscard]] const std::vector<int>& joints_to(int segment) const { return joints_to_[segment]; }

  /// Add a step to the geometry parameters, m.
  void move_geometry(const Eigen::VectorXd& step);
  /// Orthonormal columns: changes of the geometry parameters that only rotate a segment's axes.
  [[nodiscard]] Eigen::MatrixXd gauge() const;

  /// Position of joint j (also the origin of segment j + 1) and of a segment's origin, m in world.
  [[nodiscard]] Vector3d joint_centre(const ChainPose& pose, int j) const;
  [[nodiscard]] Vector3d origin(const ChainPose& pose, int segment) const;
  [[nodiscard]] Vector3d predict(const ChainPose& pose, int k) const;
  /// Typical distance of a marker from its segment's origin, m: makes rotations and positions comparable.
  [[nodiscard]] double scale() const;

 private:
  std::vector<GeometryParameter> geometry_parameters_;
  std::vector<int> rotation_offset_;
  std::vector<std::vector<int>> joints_to_;
  int frame_parameters_ = 0;
};

/// Rotate every line or plane segment into its own axes and drop what lies off them: z along the longest
/// direction from the origin through markers and joints, x the second one.
void make_canonical(Chain& chain);

/// Move a joint by `change` (m) in the axes of its parent or of its child. Joint 0 in its parent and every
/// joint in its child are the origin of these axes: there the segment's markers and other joints move the
/// other way.
void move_joint(Chain& chain, int joint, bool in_parent, const Vector3d& change);

/// Change (3 x n_g) of a joint's position with the geometry parameters, in axes of its parent or of its child
/// that the mean and the rotation of the segment's markers hold; so it does not change along the gauge.
/// Markers whose weight (K; empty: all 1) is 0 do not hold.
[[nodiscard]] Eigen::Matrix3Xd joint_by_geometry(const Chain& chain, int joint, bool in_parent,
                                                 std::span<const double> marker_weight = {});

/// Move a pose by a step in the frame's parameters.
void move_pose(const Chain& chain, const Eigen::VectorXd& step, ChainPose& pose);

/// The rotation R that maximises trace(R^T A), A = sum of w y x^T for y near R x (Horn 1987, by quaternion).
[[nodiscard]] Matrix3d nearest_rotation(const Matrix3d& A);

}  // namespace kinemark::skeleton::articulated
