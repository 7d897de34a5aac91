// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/joint_terms.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing_leg::leg;
using testing_leg::sizes_and_hip;

/// The hip of a model among the markers of pelvis or thigh, in axes turned and moved away from the body's.
MeasuredJoint hip_of(const data::ModelDescription& model, bool in_parent, const Matrix3d& covariance) {
  const Matrix3d R = Eigen::AngleAxisd(0.8, Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  const Vector3d t(0.3, -0.1, 0.2);
  MeasuredJoint out{.joint = "hip_r", .in_parent = in_parent};
  for (std::size_t m = 0; m < model.markers.size(); ++m)
    if (model.markers[m].body_idx == (in_parent ? 0 : 1)) out.markers.push_back(static_cast<int>(m));
  out.x.resize(3, static_cast<Index>(out.markers.size()));
  for (Index k = 0; k < out.x.cols(); ++k)
    out.x.col(k) =
        R * model.markers[static_cast<std::size_t>(out.markers[static_cast<std::size_t>(k)])].x_in_body + t;
  const auto& joint = model.joints[1];
  out.centre = R * (in_parent ? joint.parent_from_joint : joint.child_from_joint).translation + t;
  out.covariance = R * covariance * R.transpose();
  return out;
}

Matrix3d covariance() { return Vector3d(1e-6, 4e-6, 9e-6).asDiagonal(); }

TEST(JointTerms, vanish_where_the_model_agrees) {
  const auto model = leg();
  const auto list = sizes_and_hip(model);
  const JointTerms terms(model, list,
                         {hip_of(model, true, covariance()), hip_of(model, false, covariance())});
  const auto sums = terms.sums(Eigen::VectorXd::Zero(static_cast<Index>(list.size())));
  EXPECT_NEAR(sums.squares, 0.0, 1e-15);
  EXPECT_LT(sums.gradient.norm(), 1e-6);
}

TEST(JointTerms, count_a_displaced_joint_in_standard_deviations_of_its_axes) {
  const auto measured = hip_of(leg(), true, covariance());
  for (int axis = 0; axis < 3; ++axis) {
    auto model = leg();
    model.joints[1].parent_from_joint.translation[axis] += 0.006;
    const auto list = sizes_and_hip(model);
    const JointTerms terms(model, list, {measured});
    const double sd = 1e-3 * (axis + 1);
    EXPECT_NEAR(terms.sums(Eigen::VectorXd::Zero(static_cast<Index>(list.size()))).squares,
                0.006 * 0.006 / (sd * sd), 1e-6);
  }
}

// A whole turn or shift of the markers carries the joint with it.
TEST(JointTerms, slopes_are_those_of_finite_differences) {
  const auto model = leg();
  const auto list = sizes_and_hip(model);
  auto measured = hip_of(model, true, covariance());
  measured.centre += Vector3d(0.002, -0.003, 0.001);
  const JointTerms terms(model, list, {measured, hip_of(model, false, covariance())});
  Random random(5, 1);
  Eigen::VectorXd x(static_cast<Index>(list.size()));
  for (double& step : x) step = 1e-7 * random.gaussian();
  const auto here = terms.sums(x);
  for (Index k = 0; k < x.size(); ++k) {
    const double h = 1e-6;
    Eigen::VectorXd up = x, down = x;
    up[k] += h;
    down[k] -= h;
    const double slope = (terms.sums(up).squares - terms.sums(down).squares) / (2.0 * h);
    EXPECT_NEAR(-2.0 * here.gradient[k], slope, 1e-5 * std::abs(slope) + 1e-3)
        << list[static_cast<std::size_t>(k)].name;
  }
  EXPECT_LT((here.information - here.information.transpose()).norm(), 1e-9 * here.information.norm());
}

TEST(JointTerms, nothing_measured_says_nothing) {
  const auto model = leg();
  const auto list = sizes_and_hip(model);
  const auto sums = JointTerms(model, list, {}).sums(Eigen::VectorXd::Ones(static_cast<Index>(list.size())));
  EXPECT_EQ(sums.squares, 0.0);
  EXPECT_EQ(sums.information.norm(), 0.0);
}

}  // namespace
}  // namespace kinemark::motion::internal
