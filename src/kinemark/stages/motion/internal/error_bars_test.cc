// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/error_bars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using namespace testing_body;

struct Coverage {
  std::int64_t total = 0, one = 0, two = 0;
  void add(double error, double sd) {
    ++total;
    one += std::abs(error) <= sd;
    two += std::abs(error) <= 2.0 * sd;
  }
  [[nodiscard]] double at_one() const {
    return 100.0 * static_cast<double>(one) / static_cast<double>(total);
  }
  [[nodiscard]] double at_two() const {
    return 100.0 * static_cast<double>(two) / static_cast<double>(total);
  }
};

Coverage cover(const model::Model& model, const IkResult& result) {
  Coverage coverage;
  for (std::int64_t f = 0; f < result.motion.frames(); ++f) {
    const Eigen::VectorXd truth = coordinates(model, f);
    for (int c = 0; c < truth.size(); ++c) {
      const auto i = result.motion.index(f, c);
      if (result.motion.determined[i]) coverage.add(result.motion.q[i] - truth[c], result.motion.q_sd[i]);
    }
  }
  return coverage;
}

TEST(ErrorBars, AreTrueToTheirWordWithTheNoiseGivenOrEstimatedAndWithGaps) {
  const auto model = model::Model::compile(description()).value();
  for (const double given : {0.0, 0.002}) {
    for (const double lost : {0.0, 0.25}) {
      auto markers = record(model, 1500, 0.002, 5);
      Random random(9, 0);
      for (std::int64_t f = 0; f < 1500; ++f)
        for (std::int64_t m = 0; m < markers.markers(); ++m)
          if (random.uniform() < lost) markers.set_missing(f, m);
      IkOptions options;
      options.marker_noise_sd_m = given;
      const auto coverage = cover(model, solve_ik(model, markers, options).value());
      EXPECT_GT(coverage.total, 15000);
      EXPECT_NEAR(coverage.at_one(), 68.3, 2.0) << given << " " << lost;
      EXPECT_NEAR(coverage.at_two(), 95.4, 1.0) << given << " " << lost;
    }
  }
}

TEST(ErrorBars, FindTheNoiseOfEachMarker) {
  const auto model = model::Model::compile(description()).value();
  auto markers = record(model, 2000, 0.001, 5);
  Random random(10, 0);
  const auto loud = markers.find("S2");
  for (std::int64_t f = 0; f < 2000; ++f)
    markers.x(f, loud) += 0.006 * Eigen::Vector3d{random.gaussian(), random.gaussian(), random.gaussian()};
  const auto result = solve_ik(model, markers).value();
  for (const auto& marker : result.fit.markers) {
    if (marker.name == "S2") {
      EXPECT_NEAR(marker.noise_sd_m / std::hypot(0.001, 0.006), 1.0, 0.1);
    } else {
      // Beside a loud marker the small variances are uncertain, but they stay small.
      EXPECT_LT(marker.total_sd_m(), 0.003) << marker.name;
    }
  }
}

TEST(ErrorBars, OfAMarkerThatItsResidualsHardlyShowAreThoseOfTheOthers) {
  // Two markers on a segment of three freedoms, 60 frames: by its own residuals alone the noise of one is off
  // by half of itself in some recordings. All have the same noise, and the markers that show theirs say so.
  const auto model = model::Model::compile(description()).value();
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto result = solve_ik(model, record(model, 60, 0.001, seed)).value();
    for (const auto& marker : result.fit.markers)
      worst = std::max(worst, std::abs(marker.total_sd_m() / 0.001 - 1.0));
  }
  EXPECT_LT(worst, 0.2);
}

TEST(ErrorBars, OfMarkersWithoutAnyErrorAreZero) {
  const auto model = model::Model::compile(description()).value();
  const auto markers = record(model, 1, 0.0, 1);
  const auto problem = internal::make_problem(model, markers, {}).value();
  model::Workspace w(model);
  const Eigen::VectorXd state = model.default_state();
  model::kinematics(model, w, state);
  VarianceSums sums(problem);
  for (int f = 0; f < 100; ++f) sums.add(w.marker, Eigen::VectorXd::Ones(model.marker_count()), state);
  const auto variances = sums.variances();
  EXPECT_EQ(variances.own, Eigen::VectorXd(Eigen::VectorXd::Zero(model.marker_count())));
  EXPECT_EQ(variances.common.sum(), 0.0);
}

TEST(ErrorBars, SeeMotionThatASegmentsMarkersShare) {
  // All trunk markers slide together by 5 mm: invisible in the trunk's own shape, visible through the joints.
  const auto model = model::Model::compile(description()).value();
  auto markers = record(model, 2000, 0.0005, 5);
  Random random(12, 0);
  for (std::int64_t f = 0; f < 2000; ++f) {
    const Eigen::Vector3d common =
        0.005 * Eigen::Vector3d{random.gaussian(), random.gaussian(), random.gaussian()};
    for (const char* name : {"S1", "S2", "S3"}) markers.x(f, markers.find(name)) += common;
  }
  const auto result = solve_ik(model, markers).value();
  for (const auto& marker : result.fit.markers)
    if (marker.body == "shank") {
      EXPECT_NEAR(marker.common_sd_m, 0.005, 0.0015);
    }
  const auto coverage = cover(model, result);
  EXPECT_NEAR(coverage.at_one(), 68.3, 5.0);
}

TEST(ErrorBars, AreNotGivenWhereTheyWouldSayNothing) {
  const auto model = model::Model::compile(description()).value();
  IkOptions options;
  options.marker_noise_sd_m = 0.2;  // as large as the segments: no angle of the forearm survives that
  const auto result = solve_ik(model, record(model, 20, 0.001, 5), options).value();
  EXPECT_EQ(result.motion.determined[result.motion.index(10, 9)], 0);
  EXPECT_TRUE(std::isnan(result.motion.q_sd[result.motion.index(10, 9)]));
}

TEST(ErrorBars, ShrinkWithTheNoise) {
  const auto model = model::Model::compile(description()).value();
  const auto sd = [&](double noise) {
    const auto result = solve_ik(model, record(model, 400, noise, 5)).value();
    return result.motion.q_sd[result.motion.index(200, 9)];
  };
  EXPECT_NEAR(sd(0.004) / sd(0.001), 4.0, 0.4);
  EXPECT_LT(sd(0.0), 1e-6);
}

}  // namespace
}  // namespace kinemark::motion
