// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/bound.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/limbs.h"

namespace kinemark::skeleton {
namespace {

using data::SegmentKind;
using testing::HasSubstr;
using testing_limbs::Limb;
using testing_limbs::LimbOptions;
using testing_limbs::make_limb;

CentreBound bound_of(const Limb& limb, SegmentKind kind, double noise_sd_m) {
  const std::vector<SegmentKind> kinds(limb.layout.segments.size(), kind);
  return calc_centre_bound(limb.markers, limb.layout, kinds,
                           {.x_in_world = limb.x_true, .centre_in_world = limb.centre_in_world}, noise_sd_m)
      .value();
}

double rms(const CentreBound& bound) {
  double sum = 0.0, n = 0.0;
  for (std::size_t k = 0; k < bound.determined.size(); ++k)
    if (bound.determined[k]) sum += bound.variance(k), n += 1.0;
  return std::sqrt(sum / n);
}

double share(const CentreBound& bound) {
  double n = 0.0;
  for (const auto d : bound.determined) n += d;
  return n / static_cast<double>(bound.determined.size());
}

/// Distances, one frame and one marker fixed: what the bound of a point in line with two others must be.
TEST(CentreBound, OneFrameOfKnownGeometryIsTheLeastSquaresVariance) {
  // Line model, all six markers seen, bones at right angles: with u and w free, E has the variance that
  // solving the 7 x 7 normal equations by hand gives. Offsets c of each segment from the joint, in mm.
  const Limb limb = make_limb({.frames = 40, .seed = 3});
  const auto bound = bound_of(limb, SegmentKind::line, 0.001);
  const double c1[] = {-112.5, -75.0, -37.5}, c2[] = {37.5, 75.0, 112.5};
  double s1 = 0, s2 = 0, q1 = 0, q2 = 0;
  for (int i = 0; i < 3; ++i) s1 += c1[i], s2 += c2[i], q1 += c1[i] * c1[i], q2 += c2[i] * c2[i];
  for (std::int64_t f = 0; f < 40; ++f) {
    const auto x = [&](int m) {
      return Eigen::Map<const Eigen::Vector3d>(limb.x_true.data() + 3 * (6 * f + m));
    };
    const Eigen::Vector3d u = (x(1) - x(0)).normalized(), w = (x(4) - x(3)).normalized();
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d H =
        6.0 * I - s1 * s1 / q1 * (I - u * u.transpose()) - s2 * s2 / q2 * (I - w * w.transpose());
    EXPECT_NEAR(bound.known_geometry[static_cast<std::size_t>(6 * f)] * 1e6, H.inverse()(0, 0), 1e-6) << f;
  }
}

TEST(CentreBound, AgreesWithTheNumbersOfAnIndependentProgram) {
  // Arms of 150 and 160 mm, 300 frames, 1 mm (docs/theory): 1.39, 1.82 and 2.40 mm on a line.
  const double expected[] = {1.39, 1.82, 2.40}, determined[] = {1.0, 0.988, 0.874};
  for (int i = 0; i < 3; ++i) {
    double variance = 0.0, seen = 0.0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto bound = bound_of(make_limb({.missing = 0.2 * i, .seed = seed}), SegmentKind::line, 0.001);
      variance += std::pow(rms(bound), 2) / 3.0;
      seen += share(bound) / 3.0;
    }
    EXPECT_NEAR(1e3 * std::sqrt(variance), expected[i], 0.05 * expected[i]) << i;
    EXPECT_NEAR(seen, determined[i], 0.015) << i;
  }
}

TEST(CentreBound, ScalesWithNoiseAndItsCommonPartFallsWithFrames) {
  LimbOptions o{.frames = 100, .stagger_m = 0.020, .seed = 5};
  const auto one = bound_of(make_limb(o), SegmentKind::solid, 0.001),
             two = bound_of(make_limb(o), SegmentKind::solid, 0.002);
  EXPECT_NEAR(rms(two) / rms(one), 2.0, 1e-9);
  const auto common = [](const CentreBound& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < b.determined.size(); ++k)
      sum += b.covariance[6 * k] - b.known_geometry[6 * k];
    return sum / static_cast<double>(b.determined.size());
  };
  o.frames = 400;
  const auto many = bound_of(make_limb(o), SegmentKind::solid, 0.001);
  EXPECT_NEAR(common(one) / common(many), 4.0, 1.0);
  EXPECT_GT(common(many), 0.0);
}

TEST(CentreBound, MoreMarkersAndASimplerKindHelp) {
  const double three = rms(bound_of(make_limb({.stagger_m = 0.02, .seed = 7}), SegmentKind::solid, 0.001));
  const double eight = rms(bound_of(make_limb({.markers_per_segment = 8, .stagger_m = 0.02, .seed = 7}),
                                    SegmentKind::solid, 0.001));
  EXPECT_LT(eight, 0.8 * three);
  // Markers on a line are known to be on it: better than a plane that they happen to lie in.
  const Limb line = make_limb({.seed = 7});
  EXPECT_LT(rms(bound_of(line, SegmentKind::line, 0.001)), three);
}

TEST(CentreBound, ChainsHaveLengthsWithAnErrorThatFalls) {
  const Limb limb =
      make_limb({.frames = 100, .segments = 4, .markers_per_segment = 4, .stagger_m = 0.02, .seed = 2});
  const auto bound = bound_of(limb, SegmentKind::solid, 0.001);
  ASSERT_THAT(bound.length_sd_m, testing::SizeIs(2));
  EXPECT_THAT(bound.length_joint_b, testing::ElementsAre(1, 2));
  for (const double sd : bound.length_sd_m)
    EXPECT_THAT(sd, testing::AllOf(testing::Gt(1e-5), testing::Lt(1e-3)));
  EXPECT_EQ(share(bound), 1.0);
}

TEST(CentreBound, OneMarkerASegmentLeavesACircle) {
  Limb limb = make_limb({.frames = 50, .stagger_m = 0.02, .seed = 4});
  for (const int m : {0, 1, 3, 4}) limb.markers.set_missing(10, m);
  const auto bound = bound_of(limb, SegmentKind::solid, 0.001);
  EXPECT_EQ(bound.determined[10], 0);
  EXPECT_TRUE(std::isnan(bound.covariance[60]));
  EXPECT_EQ(bound.determined[11], 1);
}

TEST(CentreBound, SaysWhatIsWrong) {
  Limb limb = make_limb({.frames = 10, .stagger_m = 0.02});
  const auto call = [&](std::vector<SegmentKind> kinds, double noise) {
    return calc_centre_bound(limb.markers, limb.layout, kinds,
                             {.x_in_world = limb.x_true, .centre_in_world = limb.centre_in_world}, noise);
  };
  EXPECT_THAT(call({SegmentKind::solid}, 0.001).error().message, HasSubstr("kinds"));
  EXPECT_THAT(call({SegmentKind::solid, SegmentKind::solid}, 0.0).error().message, HasSubstr("more than 0"));
  limb.x_true[3 * 6 * 4] += 0.01;
  EXPECT_THAT(call({SegmentKind::solid, SegmentKind::solid}, 0.001).error().message, HasSubstr("not rigid"));
  limb = make_limb({.frames = 10});
  EXPECT_THAT(call({SegmentKind::solid, SegmentKind::line}, 0.001).error().message, HasSubstr("'s0'"));
}

}  // namespace
}  // namespace kinemark::skeleton
