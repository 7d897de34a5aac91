// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::data {

/// Geometry of a segment's markers: on a line, in a plane, or neither.
enum class SegmentKind : std::uint8_t { line, plane, solid };

/// Relative motion of two segments: about a point, or about an axis.
enum class JointKind : std::uint8_t { ball, hinge };

/// What is known of a joint centre in one frame.
enum class CentreState : std::uint8_t {
  undetermined,  ///< the visible markers leave a curve or more open: NaN
  ambiguous,     ///< several positions fit equally well; the best one is given with its own covariance
  bridged,       ///< chosen or found with the help of neighbouring frames
  determined,    ///< one position fits, from the markers of this frame alone
};

/// What the recording shows of markers that slide on their segment with the posture.
enum class SkinVerdict : std::uint8_t {
  untested,     ///< no method looked, or there was nothing to look at
  follows,      ///< the shape follows the posture, the same in one movement as in the others
  none_seen,    ///< enough movements, and nothing of it
  cannot_tell,  ///< too few movements, or neither of these
};

[[nodiscard]] std::string_view to_string(SegmentKind kind);  ///< "line", "plane", "solid"
[[nodiscard]] std::string_view to_string(JointKind kind);    ///< "ball", "hinge"
/// "untested", "follows the posture", "none seen", "cannot be told"
[[nodiscard]] std::string_view to_string(SkinVerdict verdict);
/// "undetermined", "ambiguous", "bridged", "determined"
[[nodiscard]] std::string_view to_string(CentreState state);

/// Which markers belong to which segment and which segments a joint connects: the input that every method of
/// stages/skeleton needs.
struct SegmentLayout {
  /// Markers that move together.
  struct Segment {
    std::string name;          ///< unique
    std::vector<int> markers;  ///< indices into the recording's markers
  };
  /// Two segments that meet.
  struct Joint {
    std::string name;           ///< unique
    int parent = 0, child = 0;  ///< indices of segments
  };
  /// A point of one segment that is no joint of two: where it turns about the room, or where it ends.
  struct End {
    std::string name;     ///< unique, also among the joints
    std::string segment;  ///< by its name: segments may be left out
    int marker = -1;      ///< of the segment, where it ends; -1: the point that stays where it is in the room
    [[nodiscard]] bool stays() const { return marker < 0; }  ///< whether it stays in the room
  };
  std::vector<Segment> segments;  ///< S
  std::vector<Joint> joints;      ///< J
  std::vector<End> ends;          ///< fixed joints and ends

  /// Names are unique, no marker is on two segments, indices are in range (`markers` of the recording),
  /// joints form no circle, an end's marker is on its segment.
  [[nodiscard]] Status validate(std::int64_t markers) const;
};

/// A rigid set of markers and their positions in the segment's own axes.
struct SkeletonSegment {
  std::string name;                       ///< as in the layout
  SegmentKind kind = SegmentKind::solid;  ///< how its markers lie
  std::vector<int> markers;               ///< indices into Skeleton::markers
  Eigen::Matrix3Xd x_in_segment;          ///< one column a marker, m; line: along z, plane: in x and z
};

/// Markers that slide on their segments with a joint's posture: what was looked for and found.
struct SkinAccount {
  SkinVerdict verdict = SkinVerdict::untested;  ///< what may be said
  std::int64_t movements = 0;                   ///< of the joint in this recording
  std::int64_t alike = 0;     ///< movements whose shape the others predict, on the segment that shows it more
  double p_value = kNaN;      ///< of the shape, over movements; NaN: fewer than four
  double explained = kNaN;    ///< share of the shape's variance in a movement that the others predict
  double own_slide_m = kNaN;  ///< of a marker, per axis, m per rad of the joint's motion
  double own_limit_m = kNaN;  ///< its 95 % limit
  double gap_m = kNaN;        ///< RMS of the joint's motion with the posture, where the shape shows none
  std::string description;    ///< a sentence or two; empty: untested
};

/// A joint between two segments.
struct SkeletonJoint {
  std::string name;                           ///< as in the layout
  JointKind kind = JointKind::ball;           ///< given or found
  int parent_segment = 0, child_segment = 0;  ///< indices into Skeleton::segments
  Eigen::Vector3d centre_in_parent = Eigen::Vector3d::Zero(),
                  centre_in_child = Eigen::Vector3d::Zero();  ///< m
  Eigen::Matrix3d covariance_in_parent = Eigen::Matrix3d::Zero(),
                  covariance_in_child =
                      Eigen::Matrix3d::Zero();  ///< about the bone's joint (accuracy), m^2; NaN when unknown
  /// By how much another part of the same trial would differ (repeatability), m^2: the covariance without
  /// what all parts share, as skin that always slides alike. NaN when unknown.
  Eigen::Matrix3d repeatability_in_parent = Eigen::Matrix3d::Constant(kNaN),
                  repeatability_in_child = Eigen::Matrix3d::Constant(kNaN);
  Eigen::Vector3d axis_in_parent = Eigen::Vector3d::Zero(),
                  axis_in_child = Eigen::Vector3d::Zero();  ///< unit length; zero for a ball joint
  double axis_sd_rad = 0.0;  ///< of the tilt of the axis that is known less; NaN when unknown
  /// Of the axis in the parent, rad^2: zero along it, and for a ball joint; NaN when unknown.
  Eigen::Matrix3d axis_covariance_in_parent = Eigen::Matrix3d::Zero();
  /// The same by which another part of the trial would differ.
  Eigen::Matrix3d axis_repeatability_in_parent = Eigen::Matrix3d::Constant(kNaN);
  /// How much of the accuracy is knowledge that the recording did not bring: variance of the place over what
  /// the prior for skin alone says, 0 to 1; 0 where noise outweighs skin. NaN when unknown.
  double prior_share = kNaN;
  SkinAccount skin;  ///< of the markers of its two segments
  /// The number is mostly prior knowledge.
  [[nodiscard]] bool prior_dominated() const { return prior_share > 0.5; }
  double range_of_motion_rad = 0.0;  ///< largest rotation of child against parent that was seen
  std::string method;                ///< "SCoRE", "articulated", ...
  std::string description;           ///< what the motion shows of this joint and what it does not
};

/// Distance between two joint centres of one segment.
struct SkeletonLength {
  std::string name;                   ///< "elbow to wrist"
  int joint_a = 0, joint_b = 0;       ///< indices into Skeleton::joints
  double length_m = 0.0, sd_m = 0.0;  ///< SD is NaN when unknown
};

/// A point of one segment that is no joint of two, and its way: F frames.
struct SkeletonEnd {
  std::string name;                                        ///< as in the layout
  int segment = 0;                                         ///< index into Skeleton::segments
  int marker = -1;                                         ///< as in the layout; -1: it stays in the room
  Eigen::Vector3d x_in_segment = Eigen::Vector3d::Zero();  ///< m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< of x_in_segment, about the bone's point, m^2
  int joint = -1;                                          ///< of its segment, index; -1: none
  double length_m = kNaN, length_sd_m = kNaN;              ///< from that joint
  double gap_m = kNaN;      ///< where it stays: RMS distance of its places in the room and in the segment
  SkinAccount skin;         ///< where it stays: of the segment's markers
  std::string description;  ///< what the recording shows of it
  Array<double> centre_in_world;      ///< F x 3, m; NaN where undetermined
  Array<double> covariance_in_world;  ///< F x 6 (xx xy xz yy yz zz), m^2; NaN likewise
  Array<CentreState> state;  ///< F: determined by the frame, bridged by its neighbours, or undetermined

  [[nodiscard]] bool stays() const { return marker < 0; }  ///< whether it stays in the room
};

/// Segments, joints and, frame by frame, the joint centres: F frames, J joints, metres.
struct Skeleton {
  std::vector<std::string> markers;       ///< M, as in the recording
  std::vector<SkeletonSegment> segments;  ///< as in the layout, with the positions of their markers
  std::vector<SkeletonJoint> joints;      ///< J
  std::vector<SkeletonLength> lengths;    ///< between the joints that share a segment
  std::vector<SkeletonEnd> ends;          ///< fixed joints and ends of segments, where some were asked for
  TimeBase time;                          ///< F = time.frames
  Array<double> centre_in_world;          ///< F x J x 3, m; NaN where undetermined
  Array<double> covariance;  ///< F x J x 6 (xx xy xz yy yz zz), m^2; NaN where undetermined or unknown
  Array<CentreState> state;  ///< F x J
  double noise_sd_m = 0.0;   ///< of the markers, per axis, as given or found; NaN when unknown
  std::vector<std::string> warnings;  ///< one sentence each

  [[nodiscard]] std::int64_t frames() const { return time.frames; }  ///< F
  /// Index of a joint in a frame, in every F x J array.
  [[nodiscard]] std::size_t index(std::int64_t frame, std::int64_t joint) const {
    return static_cast<std::size_t>(frame) * joints.size() + static_cast<std::size_t>(joint);
  }
  /// A centre in the world, m; NaN where undetermined.
  [[nodiscard]] Eigen::Map<const Eigen::Vector3d> centre(std::int64_t frame, std::int64_t joint) const {
    return Eigen::Map<const Eigen::Vector3d>(centre_in_world.data() + 3 * index(frame, joint));
  }
  /// Covariance of a centre, m^2.
  [[nodiscard]] Eigen::Matrix3d centre_covariance(std::int64_t frame, std::int64_t joint) const;

  /// J centres in F frames, all undetermined. Call once joints and time are set.
  void allocate_centres();
  /// Shapes agree, indices are in range, names are unique, centres are finite where they are not
  /// undetermined and NaN where they are. O(F J).
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
