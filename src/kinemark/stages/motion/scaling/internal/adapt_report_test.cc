// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/adapt_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ::testing::Contains;
using ::testing::Not;
using testing_leg::leg;

/// Sizes and joint positions.
std::vector<GeometryParameter> parameters() {
  auto list = scale_parameters(leg(), default_scale_groups(leg())).value();
  const auto joints = joint_parameters(leg()).value();
  list.insert(list.end(), joints.begin(), joints.end());
  return list;
}

MatrixXd covariance(Index size, double sd) {
  Random random(1, 1);
  MatrixXd A(size, size);
  for (Index i = 0; i < A.size(); ++i) A(i) = sd * random.gaussian() / std::sqrt(static_cast<double>(size));
  return A * A.transpose();
}

// Lengths of two geometries a small step apart differ by the derivative times the step.
TEST(Describe, the_deviation_of_a_length_is_that_of_its_parameters) {
  const auto list = parameters();
  const auto size = static_cast<Index>(list.size());
  VectorXd change(size);
  for (Index k = 0; k < size; ++k) change[k] = k % 2 == 0 ? 0.01 : -0.02;
  AdaptResult result;
  result.covariance = covariance(size, 0.01);
  describe(leg(), list, change, result.covariance, result);
  ASSERT_GE(result.lengths.size(), 2U);
  const auto lengths_at = [&](const VectorXd& x) { return segment_lengths(apply_geometry(leg(), list, x)); };
  const auto here = lengths_at(change);
  for (const auto& length : result.lengths) {
    std::size_t i = 0;
    while (i < here.size() && here[i].name != length.name) ++i;
    ASSERT_LT(i, here.size()) << length.name;
    EXPECT_NEAR(length.length_m, here[i].length_m, 1e-12);
    VectorXd slope(size);
    for (Index k = 0; k < size; ++k) {
      VectorXd up = change, down = change;
      up[k] += 1e-6;
      down[k] -= 1e-6;
      slope[k] = (lengths_at(up)[i].length_m - lengths_at(down)[i].length_m) / 2e-6;
    }
    EXPECT_NEAR(length.sd_m, std::sqrt(slope.dot(result.covariance * slope)), 1e-7) << length.name;
  }
}

TEST(Describe, determined_means_half_the_prior_from_motion_alone) {
  const auto list = scale_parameters(leg(), default_scale_groups(leg()), 0.1).value();
  const auto size = static_cast<Index>(list.size());
  AdaptResult result;
  result.covariance = 1e-6 * MatrixXd::Identity(size, size);
  MatrixXd alone = result.covariance;
  const auto index = [&](const char* name) {
    Index k = 0;
    while (list[static_cast<std::size_t>(k)].name != name) ++k;
    return k;
  };
  alone(index("shank_r"), index("shank_r")) = 0.051 * 0.051;
  alone(index("thigh_r"), index("thigh_r")) = 0.049 * 0.049;
  describe(leg(), list, VectorXd::Zero(size), alone, result);
  EXPECT_THAT(result.not_determined, Contains("shank_r"));
  EXPECT_THAT(result.not_determined, Contains("tibia_r: knee_r to ankle_r"));
  EXPECT_THAT(result.not_determined, Not(Contains("thigh_r")));
  EXPECT_THAT(result.not_determined, Not(Contains("femur_r: hip_r to knee_r")));
  const auto& shank = result.parameters[static_cast<std::size_t>(index("shank_r"))];
  EXPECT_NEAR(shank.sd, 0.001, 1e-12);
  EXPECT_NEAR(shank.interval(), 0.051, 1e-12);
  EXPECT_NEAR(result.parameters[static_cast<std::size_t>(index("thigh_r"))].interval(), 0.001, 1e-12);
}

TEST(Describe, lengths_that_no_parameter_moves_are_left_out) {
  const std::vector<std::string> ankle{"ankle_r"};
  const auto list = joint_parameters(leg(), ankle).value();
  AdaptResult result;
  result.covariance = 1e-6 * MatrixXd::Identity(3, 3);
  describe(leg(), list, VectorXd::Zero(3), result.covariance, result);
  ASSERT_EQ(result.lengths.size(), 1U);
  EXPECT_EQ(result.lengths[0].name, "tibia_r: knee_r to ankle_r");
  EXPECT_NEAR(result.lengths[0].sd_m, 0.001, 1e-12);
}

}  // namespace
}  // namespace kinemark::motion::internal
