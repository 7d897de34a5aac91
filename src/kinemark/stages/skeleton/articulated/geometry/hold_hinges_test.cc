// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/hold_hinges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "kinemark/data/joint_choice.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"
#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::move_as_hinge;
using testing_limbs::RandomChain;

constexpr double kNoise_m = 0.0005;
const HingeAxis kHinge{.joint = 0, .in_parent = Vector3d::UnitX(), .in_child = Vector3d::UnitX()};

/// A hinge about x whose centre was found `shift_m` along the axis from where it was simulated.
struct ShiftedHinge {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 80});
  FittedChain fit;

  explicit ShiftedHinge(double shift_m, double noise_m = kNoise_m) {
    move_as_hinge(limb, noise_m);
    fit = known_geometry(limb, kNoise_m);
    fit.frames.resize(limb.pose.size());
    std::iota(fit.frames.begin(), fit.frames.end(), 0);
    move_joint(fit.chain, 0, true, shift_m * kHinge.in_parent);
    move_joint(fit.chain, 0, false, shift_m * kHinge.in_child);
  }
  /// Of the centre beside the middle of both segments' markers, m.
  [[nodiscard]] double along() const {
    return 0.5 * (kHinge.in_parent.dot(joint_from_markers(fit.chain, 0, true)) +
                  kHinge.in_child.dot(joint_from_markers(fit.chain, 0, false)));
  }
  /// A marker's distance from the joint, and its SD as the fit states it, m.
  [[nodiscard]] double radius(int k) const { return fit.chain.marker.col(k).norm(); }
  [[nodiscard]] double radius_sd(int k) const {
    const Vector3d outwards = fit.chain.marker.col(k).normalized();
    const Eigen::Matrix3d own = fit.geometry_covariance.block<3, 3>(3 * k, 3 * k);  // joint 0: markers alone
    return std::sqrt(outwards.dot(own * outwards));
  }
};

// Held once in the parent and once in the child, the position along the axis is known by 1 / sqrt(2) of a
// hold.
constexpr double kHeldSd_m = kHingeHold_m / std::numbers::sqrt2;

// Wherever it was found: it returns to where it was simulated by three SDs of the hold, and the markers to
// their distances from it by four of the SDs that the fit states (24 distances; one in 16,000 lies beyond),
// which are those of the hold and of noise: a marker's direction lies to at most 56 % along the axis.
TEST(HoldHinges, TheCentreReturnsToTheMiddleOfTheMarkers) {
  for (const double shift_m : {-0.05, 0.0, 0.08}) {
    ShiftedHinge hinge(shift_m);
    hold_hinges(hinge.limb.samples, {kHinge}, hinge.fit);
    EXPECT_NEAR(hinge.along(), 0.0, 3.0 * kHeldSd_m) << shift_m;
    for (int k = 0; k < 8; ++k) {
      EXPECT_NEAR(hinge.radius(k), hinge.limb.chain.marker.col(k).norm(), 4.0 * hinge.radius_sd(k))
          << shift_m << ' ' << k;
      EXPECT_LT(hinge.radius_sd(k), kHeldSd_m) << shift_m << ' ' << k;
    }
  }
}

// Without noise frames show nothing of the position along the axis but that it is the same for both segments,
// by 0.8 mm in one frame and 0.09 mm in all 80: the variance is that of the two holds and a hundredth more.
TEST(HoldHinges, TheCovarianceAlongTheAxisIsThatOfTheHold) {
  ShiftedHinge hinge(0.02, 0.0);  // noise would look like motion about other axes
  hold_hinges(hinge.limb.samples, {kHinge}, hinge.fit);
  for (const bool in_parent : {true, false}) {
    const double held = hinge.fit.joint_covariance(0, in_parent)(0, 0);
    EXPECT_NEAR(held, kHeldSd_m * kHeldSd_m, 0.03 * kHeldSd_m * kHeldSd_m);
  }
  hold_hinges(hinge.limb.samples, {}, hinge.fit);
  const double open = 0.5 * data::kJointPriorSd_m * data::kJointPriorSd_m;
  EXPECT_GT(hinge.fit.joint_covariance(0, false)(0, 0), 0.5 * open) << "only the prior is left";
}

TEST(HoldHinges, WithoutHingesTheGeometryStaysAtItsMinimum) {
  RandomChain limb = make_random_chain({.frames = 40, .noise_sd_m = 0.0});
  FittedChain fit = known_geometry(limb, kNoise_m);
  fit.frames.resize(40);
  std::iota(fit.frames.begin(), fit.frames.end(), 0);
  hold_hinges(limb.samples, {}, fit);
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(fit.chain.marker.col(k).norm(), limb.chain.marker.col(k).norm(), 1e-5) << k;
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
