// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Limbs of two segments whose markers slide on the bone as skin does: several kinds of skin, none of them
// that of the estimator.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skin_limbs {

/// Hip and shoulder are balls, knee and elbow hinges.
enum class Limb : std::uint8_t { hip, shoulder, knee, elbow };

/// How the markers move on the bone, beside white noise.
enum class Skin : std::uint8_t {
  none,      ///< not at all
  coloured,  ///< AR(1) of 0.98 at 100 Hz, marker by marker and axis by axis; no skin
  linear,    ///< in proportion to the posture: each by itself, and 0.7 as much together
  rigid,     ///< the same, nearly all of it as one body, with a turn
  curved,    ///< sums of tanh of the posture, as a body, as a turn and each; other gains from movement to
             ///< movement; wanders
  late,      ///< the cluster along its segment, with a gradient and a natural frequency; accelerations; turns
             ///< with the segment
  plate,     ///< the whole cluster along its segment, late, and nothing deforms
  sheet,     ///< a field over the segment, so that neighbours slide alike, with play between there and back
};

/// The directions of the arcs of a ball joint.
enum class Arcs : std::uint8_t { star, two, one };

struct Case {
  Limb limb = Limb::hip;
  Skin skin = Skin::none;
  double slide_m = 0.007;  ///< RMS of a marker of the softer segment; SD of coloured noise
  Arcs arcs = Arcs::star;  ///< of balls
  double range_deg = 40.0;
  int movements = 8;
  double noise_m = 0.0005;  ///< white, per axis
  std::uint64_t seed = 1;
};

struct Subject {
  data::Trajectories markers;
  data::SegmentLayout layout;                      ///< "parent", "child", "joint"
  std::array<Eigen::Matrix3Xd, 2> bone;            ///< of each segment: markers on the bone, m
  std::array<Eigen::Vector3d, 2> centre;           ///< of the joint in either bone
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< of a hinge, in both; zero for a ball
  double deforming = 0.0;  ///< share of the slides' energy that no movement as one body explains
};

[[nodiscard]] constexpr bool is_ball(Limb limb) { return limb == Limb::hip || limb == Limb::shoulder; }
[[nodiscard]] std::string_view to_string(Limb limb);  ///< "hip", ...
[[nodiscard]] std::string_view to_string(Skin skin);  ///< "no skin", ...

[[nodiscard]] Subject make_subject(const Case& of);

/// A joint beside its truth in the parent's axes: error and covariance of the numbers that can be known,
/// three of a ball, two across a hinge's axis at the height of the true point; and the tilts of a hinge's
/// axis.
struct Comparison {
  Eigen::VectorXd error;
  Eigen::MatrixXd covariance;
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
  Eigen::Matrix2d tilt_covariance = Eigen::Matrix2d::Zero();
};
[[nodiscard]] Comparison compare(const data::Skeleton& skeleton, const Subject& subject);

}  // namespace kinemark::skin_limbs
