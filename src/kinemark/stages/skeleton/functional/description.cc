// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/description.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinemark/core/units.h"

namespace kinemark::skeleton {
namespace {

constexpr double kKnown_m = 0.01;     ///< a position with a larger SD is reported as not known
constexpr double kKnown_rad = 0.175;  ///< ten degrees
constexpr double kSmall_rad = 0.1;    ///< SD of a motion that is too small to tell a centre
constexpr double kOneArc = 0.25;      ///< of the second SD of the rotation over the first
constexpr double kRepeats = 0.7;      ///< SD between parts of the trial over that about the bone
constexpr double kStill_rad = 0.035;  ///< two degrees of motion are none

std::string millimetres(double m) { return fmt::format("{:.1f} mm", 1e3 * m); }

std::string describe_hinge(const data::SkeletonJoint& joint, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d axis = joint.axis_in_parent.norm() > 0.5 ? joint.axis_in_parent : joint.axis_in_child;
  const Eigen::Matrix3d off = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  const double across = std::sqrt(std::max(0.0, 0.5 * (off * covariance * off).trace()));
  const bool direction = joint.axis_sd_rad < kKnown_rad;
  std::string text = direction
                         ? fmt::format("axis direction known to {:.1f} deg", joint.axis_sd_rad * kDegPerRad)
                         : std::string("axis direction not known");
  text += across < kKnown_m ? fmt::format(", its position to {}", millimetres(across)) : ", its position not";
  return text + ", position along it not";
}

/// Why a centre is known so badly, where the motion tells.
std::string describe_lack(const Eigen::Vector3d& sd_rad) {
  if (sd_rad(0) < kSmall_rad) return ": the motion was too small";
  if (sd_rad(1) < kOneArc * sd_rad(0))
    return fmt::format(": the motion was one arc only (SD {:.1f} deg, {:.1f} deg beside it)",
                       sd_rad(0) * kDegPerRad, sd_rad(1) * kDegPerRad);
  return "";
}

std::string describe_ball(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& sd_rad) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d sd = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (sd(2) < kKnown_m) return fmt::format("centre known to {}", millimetres(sd(2)));
  const std::string why = describe_lack(sd_rad);
  if (sd(1) < kKnown_m)
    return fmt::format("centre known to {} across one direction, to {} along it{}", millimetres(sd(1)),
                       millimetres(sd(2)), why);
  if (sd(0) < kKnown_m)
    return fmt::format("centre known to {} in one direction only, to {} in the others{}", millimetres(sd(0)),
                       millimetres(sd(2)), why);
  return fmt::format("centre not known ({}){}", millimetres(sd(2)), why);
}

/// What the same skin shows again and what it hides: said where most of the doubt is shared by all parts of
/// the trial.
std::string describe_repeatability(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& repeatability,
                                   const Eigen::Vector3d& axis) {
  if (!repeatability.allFinite()) return "";
  const Eigen::Matrix3d off = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  const auto largest = [&](const Eigen::Matrix3d& c) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(off * c * off, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, solver.eigenvalues()(2)));
  };
  const double repeats = largest(repeatability);
  if (!(repeats < kRepeats * largest(covariance)) || repeats >= kKnown_m) return "";
  return fmt::format("; another part of the trial repeats it to {}", millimetres(repeats));
}

/// What the error bar rests on, where that is not the recording.
std::string describe_source(const data::SkeletonJoint& joint) {
  if (!joint.prior_dominated()) return "";
  std::string text =
      "; prior-dominated: most of this is what is known of skin, not what this recording shows";
  if (joint.kind == data::JointKind::hinge)
    text += " (1 mm of sliding per rad moves the axis by 1 mm and leaves no trace)";
  return text;
}

}  // namespace

std::string describe_joint(const data::SkeletonJoint& joint, const Eigen::Vector3d& sd_rad) {
  const bool in_parent = joint.covariance_in_parent.allFinite();
  const Eigen::Matrix3d& covariance = in_parent ? joint.covariance_in_parent : joint.covariance_in_child;
  const std::string motion =
      std::isnan(joint.range_of_motion_rad)
          ? std::string("motion not seen as an angle")
          : fmt::format("{:.0f} deg of motion", joint.range_of_motion_rad * kDegPerRad);
  if (!covariance.allFinite()) return motion + ": centre not known";
  if (joint.range_of_motion_rad < kStill_rad)
    return motion + ": the joint hardly moves, neither centre nor axis can be known";
  const bool hinge = joint.kind == data::JointKind::hinge;
  const Eigen::Vector3d& axis = in_parent ? joint.axis_in_parent : joint.axis_in_child;
  return motion + ": " + (hinge ? describe_hinge(joint, covariance) : describe_ball(covariance, sd_rad)) +
         describe_repeatability(
             covariance, in_parent ? joint.repeatability_in_parent : joint.repeatability_in_child, axis) +
         describe_source(joint);
}

}  // namespace kinemark::skeleton
