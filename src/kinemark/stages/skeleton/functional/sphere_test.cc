// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/sphere.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::Rotations;

struct Still {
  testing::TestChain chain;
  SegmentPoses a;
  explicit Still(const testing::ChainSetup& setup) : chain(testing::make_chain(setup)) {
    a = find_segment_poses({chain.markers, {}}, "a", chain.layout.segments[0].markers);
  }
  [[nodiscard]] SphereFit fit(const SphereOptions& options = {}) const {
    return fit_spheres({chain.markers, {}}, a, chain.layout.segments[1].markers, options);
  }
  [[nodiscard]] Eigen::Vector3d truth() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
      if (a.known[static_cast<std::size_t>(f)]) sum += a.to_segment(f, chain.centres[0].col(f));
    return sum / static_cast<double>(a.known_frames);
  }
};

TEST(Sphere, ExactDataGiveCentreAndRadii) {
  const Still still({.per_segment = 4, .rotations = Rotations::cone, .range_rad = 0.8, .missing = 0.1});
  const auto fit = still.fit();
  ASSERT_TRUE(fit.found);
  EXPECT_LT((fit.centre - still.truth()).norm(), 1e-6);
  for (Eigen::Index k = 0; k < 4; ++k)
    EXPECT_NEAR(fit.radii_m(k), still.chain.x_in_segment[1].col(k).norm(), 1e-6);
  EXPECT_LT(fit.residual_rms_m, 1e-7);
}

TEST(Sphere, OneMarkerSuffices) {
  const Still still({.per_segment = 4, .rotations = Rotations::anywhere});
  const auto fit =
      fit_spheres({still.chain.markers, {}}, still.a, {still.chain.layout.segments[1].markers[2]});
  ASSERT_TRUE(fit.found);
  EXPECT_LT((fit.centre - still.truth()).norm(), 1e-6);
}

TEST(Sphere, CorrectionTakesTheBiasAway) {
  // Mean over seeds: plain is drawn towards the markers by far more than chance, corrected is not.
  Eigen::Vector3d plain = Eigen::Vector3d::Zero(), corrected = Eigen::Vector3d::Zero();
  const int runs = 40;
  for (int seed = 1; seed <= runs; ++seed) {
    testing::ChainSetup setup{.frames = 200,
                              .per_segment = 6,
                              .stagger_m = 0.05,
                              .rotations = Rotations::cone,
                              .range_rad = 0.5,
                              .seed = static_cast<std::uint64_t>(seed)};
    const Still exact(setup);
    setup.noise_sd_m = 0.001;
    const auto noisy = testing::make_chain(setup);
    const auto fit = [&](bool correct) -> Eigen::Vector3d {
      const auto& moving = noisy.layout.segments[1].markers;
      return fit_spheres({noisy.markers, {}}, exact.a, moving, {.correct_bias = correct}).centre;
    };
    plain += (fit(false) - exact.truth()) / runs;
    corrected += (fit(true) - exact.truth()) / runs;
  }
  EXPECT_GT(plain.norm(), 1e-3);
  EXPECT_LT(corrected.norm(), 0.25 * plain.norm());
}

TEST(Sphere, CirclesHaveAnAxis) {
  const Still still({.per_segment = 4, .rotations = Rotations::hinge, .range_rad = 1.0});
  const auto fit = still.fit({.about_axis = true});
  for (std::int64_t f = 0; f < 20; ++f) {
    const Eigen::Vector3d axis = still.chain.world_from_segment[0][static_cast<std::size_t>(f)].col(0);
    EXPECT_NEAR(std::abs(axis.dot(still.a.world_from_segment[static_cast<std::size_t>(f)] * fit.axis)), 1.0,
                1e-9);
    const Eigen::Vector3d off = still.a.to_world(f, fit.centre) - still.chain.centres[0].col(f);
    EXPECT_LT((off - axis * axis.dot(off)).norm(), 1e-6);
  }
  EXPECT_LT(fit.axis_sd_rad, 1e-6);
}

TEST(Sphere, CovarianceCoversTheTruth) {
  int inside = 0;
  for (int seed = 1; seed <= 60; ++seed) {
    const Still still({.frames = 200,
                       .per_segment = 5,
                       .stagger_m = 0.04,
                       .rotations = Rotations::cone,
                       .range_rad = 1.2,
                       .noise_sd_m = 0.0005,
                       .seed = static_cast<std::uint64_t>(seed)});
    const auto fit = still.fit();
    const Eigen::Vector3d d = fit.centre - still.truth();
    inside += d.dot(fit.covariance.inverse() * d) < 7.815;
  }
  EXPECT_GE(inside, 50) << "of 60; 57 expected";
}

TEST(Sphere, PointsThatDoNotMoveTellNothing) {
  const Still still({.per_segment = 4, .rotations = Rotations::cone, .range_rad = 0.0, .noise_sd_m = 0.001});
  const auto fit = still.fit();
  EXPECT_GT(fit.covariance.trace(), 0.05 * 0.05);
  const Still few({.frames = 3});
  EXPECT_FALSE(few.fit().found);
}

}  // namespace
}  // namespace kinemark::skeleton
