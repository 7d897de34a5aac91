// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What marker names mean: the place on the body that laboratories agree to give a marker of that name, and
// how far apart they put it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinemark::motion {

/// Side of the body.
enum class Side : std::uint8_t { middle, left, right };

/// Segments that a marker may be on.
enum class BodyPart : std::uint8_t {
  pelvis,
  thigh,
  shank,
  foot,
  trunk,
  head,
  upper_arm,
  forearm,
  hand,
  shoulder
};

/// How far markers lie from the place that their name gives, 1 SD per axis (forward, up, outward), m.
struct PlaceSpread {
  Eigen::Vector3d common = Eigen::Vector3d::Constant(0.020);  ///< both sides alike: the laboratory's habit
  Eigen::Vector3d own = Eigen::Vector3d::Constant(0.012);     ///< each marker by itself
  /// From one posture to another: what it lies on bends, or slides under skin.
  Eigen::Vector3d by_posture = Eigen::Vector3d::Zero();
};

/// A marker's place on the body of a man of 1.75 m who stands: x forward, y up, z outward (to the right for
/// those in the middle), from the joint at the segment's near end.
struct Landmark {
  BodyPart part = BodyPart::pelvis;                     ///< segment
  Side side = Side::middle;                             ///< of the body
  Eigen::Vector3d x_in_part = Eigen::Vector3d::Zero();  ///< m
  PlaceSpread spread;                                   ///< as laboratories differ
};

/// Name without subject prefix, case and the characters . _ - and blank, cut into side and rest: "R.ASIS" and
/// "RASIS" are {right, "ASIS"}, "C7" is {middle, "C7"}.
struct SidedName {
  Side side = Side::middle;  ///< as the name tells
  std::string stem;          ///< rest of the name, upper case
};

/// Side and stem of a marker's name. A first L or R is a side where the rest is a known landmark; else a last
/// one is; a first L or R before anything else is one too.
[[nodiscard]] SidedName split_marker_name(std::string_view name);

/// Place of a marker of this name; nothing where laboratories do not agree on what the name means.
[[nodiscard]] std::optional<Landmark> landmark_of(std::string_view name);

}  // namespace kinemark::motion
