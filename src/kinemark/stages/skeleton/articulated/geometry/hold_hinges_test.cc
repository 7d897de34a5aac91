// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/hold_hinges.h"

#include <gtest/gtest.h>

#include <numeric>

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
  [[nodiscard]] double along() const {
    return kHinge.in_parent.dot(joint_from_markers(fit.chain, 0, true)) +
           kHinge.in_child.dot(joint_from_markers(fit.chain, 0, false));
  }
};

TEST(HoldHinges, TheCentreReturnsToTheMiddleOfTheMarkers) {
  for (const double shift_m : {-0.05, 0.0, 0.08}) {
    ShiftedHinge hinge(shift_m);
    hold_hinges(hinge.limb.samples, {kHinge}, hinge.fit);
    EXPECT_NEAR(hinge.along(), 0.0, 0.002) << shift_m;
    for (int k = 0; k < 8; ++k) {
      EXPECT_NEAR(hinge.fit.chain.marker.col(k).norm(), hinge.limb.chain.marker.col(k).norm(), 0.003)
          << shift_m << ' ' << k;
    }
  }
}

// What is held is known to millimetres, with what the segment's own axes add; what nothing shows is not.
TEST(HoldHinges, TheCovarianceAlongTheAxisFollowsTheHold) {
  ShiftedHinge hinge(0.02, 0.0);  // noise would look like motion about other axes
  hold_hinges(hinge.limb.samples, {kHinge}, hinge.fit);
  const double held = hinge.fit.joint_covariance(0, false)(0, 0);
  EXPECT_GT(held, 0.0);
  EXPECT_LT(held, 100.0 * kHingeHold_m * kHingeHold_m);
  hold_hinges(hinge.limb.samples, {}, hinge.fit);
  EXPECT_GT(hinge.fit.joint_covariance(0, false)(0, 0), 100.0 * held) << "open again";
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
