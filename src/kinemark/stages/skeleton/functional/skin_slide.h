// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What skin that slides with the posture does to a joint: every movement repeats the same error, so scatter
// alone does not show it. Theory: docs/theory/joint-centres-skin.md
#pragma once

#include <Eigen/Core>

#include <cstdint>

#include "kinemark/core/result.h"
#include "kinemark/stages/skeleton/functional/joint_fit.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton {

// What is known of skin before a recording is seen.

/// How far a segment's markers slide as one body, in proportion to how far each slides by itself. The latter
/// shows in their shape, the former leaves little or no trace. On thighs and shanks half of the energy
/// (Grimpampi et al. 2014, IEEE Trans Biomed Eng 61:362) to 80 % of it (Barre et al. 2013, ibid. 60:3131)
/// moves the markers as one body: 0.4 to 1.1 times the own slide for translation and turn. People differ by a
/// factor of two.
struct SkinPrior {
  double ball = 1.0;          ///< median of common over own slide, of a ball joint
  double hinge = 1.4;         ///< the same of a hinge
  double ball_factor = 1.6;   ///< one SD of its logarithm, as a factor, of a ball joint
  double hinge_factor = 2.0;  ///< the same of a hinge
  double anywhere = 1e-3;     ///< probability that the common slide has nothing to do with the own one
  /// Skin is no linear and quadratic function of the posture: what is left over, as a share of the slide.
  double misfit = 0.3;

  /// More than 0 and finite; factors beyond 1, probability below 1.
  [[nodiscard]] Status check() const;
};

/// Slides of the markers as random effects, and what they leave of a joint that least squares of the gap
/// between its two places found.
///
/// Posture is the rotation of child against parent from its mean. A segment's markers slide, each by itself,
/// by a random linear and quadratic function of the posture; their size shows in how the shape follows the
/// posture. As one body they slide and turn by amounts whose prior is tied to that size (SkinPrior), and
/// which the gap tells as far as it can: on a grid, integrated out. All of it is carried to the joint by the
/// lever from the markers. What does not deform is taken not to slide.
struct SkinSlide {
  /// false: too few frames show all markers (40), a motion of no more than 2 deg (SD), or a gap of no more
  /// than rounding (0.1 um); all below is zero
  bool known = false;
  /// own slide of a marker, per axis, m per rad: RMS over what is likely
  double own_parent_m = 0.0, own_child_m = 0.0;
  double own_limit_m = 0.0;   ///< 95 % limit of the larger of the two, m per rad
  double none = 1.0;          ///< probability that no marker slides by itself on either segment
  double common_m = 0.0;      ///< slide of the softer segment's markers as one body, m per rad
  double turn_m = 0.0;        ///< their turn as one body, at their radius, m per rad
  double frames_alike = 1.0;  ///< frames that count as one, as errors of neighbours are alike
  /// The joint's expected place less the one of least squares; zero along a hinge's axis, m.
  Vector6 shift = Vector6::Zero();
  Matrix6 covariance = Matrix6::Zero();  ///< about that expected place, m^2; none along a hinge's axis
  Matrix6 noise = Matrix6::Zero();       ///< the part of it by noise that does not repeat itself, m^2
  /// By how much another part of the trial, with movements of its own, would differ, m^2: the same skin
  /// slides in it in the same way, so what the movements share is left out.
  Matrix6 repeatability = Matrix6::Zero();
  Eigen::Matrix3d axis_covariance = Eigen::Matrix3d::Zero();  ///< of a hinge's axis in the parent, rad^2
  double moves_m = 0.0;  ///< how far slides of this size take least squares from the place, RMS, m
  /// How much of what the prior says of the place is left when the recording was seen: variance over
  /// variance, 0 to 1; 0 where noise outweighs the slides.
  double prior_share = 0.0;
};

/// @param score  of the same segments and frames, see fit_score()
/// At most some 3,000 frames, 50 a second, are used. O(frames).
[[nodiscard]] SkinSlide measure_skin_slide(const Samples& samples, const SegmentPoses& parent,
                                           const SegmentPoses& child, const RelativeMotion& motion,
                                           const JointFit& score, const SkinPrior& prior = {});

/// A difference of covariances without what is below nothing.
[[nodiscard]] Matrix6 positive_part(const Matrix6& C);

/// Gives a least-squares joint the covariance about the bone, the repeatability and the account of skin: the
/// joint stays where it is, and the way to its expected place counts as error. Nothing where the slides are
/// not known.
void widen_by_skin(const Samples& samples, const SegmentPoses& parent, const SegmentPoses& child,
                   const RelativeMotion& motion, JointFit& fit, const SkinPrior& prior = {});

}  // namespace kinemark::skeleton
