// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/marker_account.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

/// Two frames, markers A and B; errors along z in m, NaN where not seen.
data::JointMotion motion_with(double a0, double b0, double a1, double b1) {
  data::JointMotion motion;
  motion.markers = {"A", "B"};
  motion.time = {.rate_hz = 100.0, .frames = 2};
  for (const double z : {a0, b0, a1, b1})
    for (const double value : {std::isnan(z) ? kNaN : 0.0, std::isnan(z) ? kNaN : 0.0, z})
      motion.marker_error.push_back(value);
  return motion;
}

TEST(MarkerAccount, CountsWhatIsSeenOnly) {
  data::MarkerFit fit{.markers = {{.name = "A", .max_m = 9.0}, {.name = "B"}}, .max_error_m = 9.0};
  add_marker_errors(motion_with(0.003, kNaN, -0.001, 0.002), fit);
  EXPECT_DOUBLE_EQ(fit.markers[0].seen, 1.0);
  EXPECT_DOUBLE_EQ(fit.markers[0].rms_m, std::sqrt((9e-6 + 1e-6) / 2.0));
  EXPECT_DOUBLE_EQ(fit.markers[0].max_m, 0.003) << "what stood there before is gone";
  EXPECT_DOUBLE_EQ(fit.markers[1].seen, 0.5);
  EXPECT_DOUBLE_EQ(fit.markers[1].rms_m, 0.002);
  EXPECT_DOUBLE_EQ(fit.rms_error_m, std::sqrt((9e-6 + 1e-6 + 4e-6) / 3.0));
  EXPECT_DOUBLE_EQ(fit.max_error_m, 0.003);
  EXPECT_NEAR(fit.mean_error_m.z(), 0.004 / 3.0, 1e-15);
  EXPECT_EQ(fit.mean_error_m.x(), 0.0);
}

TEST(MarkerAccount, WhatIsNeverSeenIsNotZeroButUnknown) {
  data::MarkerFit fit{.markers = {{.name = "A"}, {.name = "B"}}, .rms_error_m = 0.0};
  add_marker_errors(motion_with(kNaN, kNaN, kNaN, kNaN), fit);
  EXPECT_TRUE(std::isnan(fit.rms_error_m));
  EXPECT_TRUE(std::isnan(fit.mean_error_m.norm()));
  EXPECT_TRUE(std::isnan(fit.markers[0].rms_m));
  EXPECT_EQ(fit.markers[0].seen, 0.0);
  EXPECT_EQ(fit.max_error_m, 0.0);
}

TEST(MarkerAccount, NoiseIsOfTheMarkerAndOfItsBody) {
  const auto model = model::Model::compile(testing_body::description()).value();
  const auto M = model.marker_count();
  MarkerVariances variances{
      .own = Eigen::VectorXd::LinSpaced(M, 1.0, M).array().square(),
      .common = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.bodies().size()))};
  const auto body = model.markers()[3].body;
  variances.common[body] = 0.25;
  data::MarkerFit fit;
  for (int m = 0; m < M; ++m) fit.markers.push_back({.name = std::to_string(m)});
  add_marker_noise(model, variances, fit);
  for (int m = 0; m < M; ++m) {
    const auto& marker = fit.markers[static_cast<std::size_t>(m)];
    EXPECT_DOUBLE_EQ(marker.noise_sd_m, m + 1.0);
    EXPECT_EQ(marker.common_sd_m, model.markers()[static_cast<std::size_t>(m)].body == body ? 0.5 : 0.0);
  }
}

}  // namespace
}  // namespace kinemark::motion::internal
