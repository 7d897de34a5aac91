// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/kinematics.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "kinemark/model/state.h"
#include "kinemark/model/testing/random_tree.h"

namespace kinemark::model {
namespace {

using testing::random_state;
using testing::random_tree;
using testing::random_vector;
using testing::relative_error;

constexpr double kStep = 1e-5;

class RandomTree : public ::testing::TestWithParam<int> {
 protected:
  std::uint64_t seed() const { return static_cast<std::uint64_t>(GetParam() / 2); }
  Random random{seed() + 100, 1};
  Model model = Model::compile(random_tree(seed()), {.free_roots = GetParam() % 2 == 0}).value();
  Workspace w{model};

  VectorXd markers_at(const VectorXd& x) {
    kinematics(model, w, x);
    return w.marker.reshaped();
  }
  VectorXd moved(VectorXd x, const VectorXd& dv) const {
    integrate(model, x, dv);
    return x;
  }
  // Central difference of f(x) along every speed.
  template <class F>
  Eigen::MatrixXd slope_of(const F& f, const VectorXd& x) const {
    Eigen::MatrixXd D;
    for (int i = 0; i < model.speed_count(); ++i) {
      const VectorXd step = kStep * VectorXd::Unit(model.speed_count(), i);
      const VectorXd column = (f(moved(x, step)) - f(moved(x, -step))) / (2.0 * kStep);
      if (i == 0) D.resize(column.size(), model.speed_count());
      D.col(i) = column;
    }
    return D;
  }
};

INSTANTIATE_TEST_SUITE_P(Seeds, RandomTree, ::testing::Range(0, 16));

TEST_P(RandomTree, MarkerJacobianIsTheSlopeOfTheMarkers) {
  double worst = 0.0;
  for (int trial = 0; trial < 4; ++trial) {
    const VectorXd x = random_state(model, random);
    const Eigen::MatrixXd expected = slope_of([&](const VectorXd& y) { return markers_at(y); }, x);
    kinematics(model, w, x);
    Eigen::MatrixXd J;
    marker_jacobian(model, w, J);
    worst = std::max(worst, relative_error(J, expected));
  }
  EXPECT_LT(worst, 1e-7);
  RecordProperty("measured", fmt::format("{:.2e}", worst));
}

TEST_P(RandomTree, PointJacobianAndVelocityAgree) {
  const VectorXd x = random_state(model, random), v = random_vector(model.speed_count(), 2.0, random);
  kinematics(model, w, x);
  velocities(model, w, v);
  Eigen::MatrixXd J(3, model.speed_count());
  for (int b = data::kGround; b < static_cast<int>(model.bodies().size()); ++b) {
    const Vector3d p = point_in_world(w, b, Vector3d(0.1, -0.2, 0.3));
    point_jacobian(model, w, b, p, J);
    EXPECT_LT((J * v - point_velocity(w, b, p)).norm(), 1e-12);
  }
}

TEST_P(RandomTree, JdotVIsTheAccelerationAtConstantSpeeds) {
  double worst = 0.0;
  for (int trial = 0; trial < 4; ++trial) {
    const VectorXd x = random_state(model, random), v = random_vector(model.speed_count(), 2.0, random);
    const auto marker_velocity = [&](const VectorXd& y) -> VectorXd {
      kinematics(model, w, y);
      Eigen::MatrixXd J;
      marker_jacobian(model, w, J);
      return J * v;
    };
    const VectorXd expected =
        (marker_velocity(moved(x, kStep * v)) - marker_velocity(moved(x, -kStep * v))) / (2.0 * kStep);
    kinematics(model, w, x);
    velocities(model, w, v);
    VectorXd bias;
    marker_bias_acceleration(model, w, bias);
    worst = std::max(worst, relative_error(bias, expected));
  }
  EXPECT_LT(worst, 1e-7);
  RecordProperty("measured", fmt::format("{:.2e}", worst));
}

TEST_P(RandomTree, PointConstraintJacobianIsTheSlopeOfTheGaps) {
  const VectorXd x = random_state(model, random);
  const auto gaps_at = [&](const VectorXd& y) {
    kinematics(model, w, y);
    VectorXd gap;
    point_constraint_gaps(model, w, gap);
    return gap;
  };
  ASSERT_EQ(gaps_at(x).size(), 6);
  const Eigen::MatrixXd expected = slope_of(gaps_at, x);
  kinematics(model, w, x);
  Eigen::MatrixXd C;
  point_constraint_jacobian(model, w, C);
  EXPECT_GT(C.norm(), 0.1);
  EXPECT_LT(relative_error(C, expected), 1e-7);
}

TEST_P(RandomTree, RotationsStayRotations) {
  kinematics(model, w, random_state(model, random));
  for (const auto& R : w.rotation) {
    EXPECT_LT((R.transpose() * R - Matrix3d::Identity()).norm(), 1e-13);
    EXPECT_GT(R.determinant(), 0.0);
  }
}

TEST_P(RandomTree, GroundMarkersStay) {
  kinematics(model, w, random_state(model, random));
  velocities(model, w, random_vector(model.speed_count(), 2.0, random));
  Eigen::MatrixXd J;
  VectorXd bias;
  marker_jacobian(model, w, J);
  marker_bias_acceleration(model, w, bias);
  int seen = 0;
  for (int m = 0; m < model.marker_count(); ++m)
    if (model.markers()[static_cast<std::size_t>(m)].body == data::kGround) {
      ++seen;
      EXPECT_EQ(Vector3d(w.marker.col(m)),
                model.description().markers[static_cast<std::size_t>(m)].x_in_body);
      EXPECT_EQ(J.middleRows(3 * m, 3).norm(), 0.0);
      EXPECT_EQ(bias.segment<3>(3 * m).norm(), 0.0);
    }
  EXPECT_EQ(seen, 2);
}

// A joint written out by hand, with OpenSim's order: offset frame, translations in the parent's joint frame,
// rotations in the order listed, offset frame of the child backwards.
TEST(Kinematics, PutsTheChildWhereTheDescriptionSays) {
  data::ModelDescription d;
  d.bodies.push_back({.name = "b", .mass = 1.0});
  d.coordinates.push_back({.name = "angle", .default_value = 0.0});
  data::JointDescription joint{
      .name = "j", .type = "CustomJoint", .parent_body_idx = data::kGround, .child_body_idx = 0};
  joint.parent_from_joint.translation = {1.0, 0.0, 0.0};
  joint.parent_from_joint.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // 90 degrees about z
  joint.child_from_joint.translation = {0.0, 0.5, 0.0};
  joint.axes.push_back({.is_rotation = true, .axis = {0, 0, 2}, .coordinate_idx = 0});
  joint.axes.push_back({.is_rotation = false,
                        .axis = {1, 0, 0},
                        .coordinate_idx = 0,
                        .function = math::ScalarFunction::linear(2.0, 0.25)});
  d.joints.push_back(joint);
  d.markers.push_back({.name = "m", .body_idx = 0, .x_in_body = {0.0, 0.0, 0.0}});
  const Model model = Model::compile(d).value();
  Workspace w(model);
  VectorXd x(1);
  x << 0.3;
  kinematics(model, w, x);
  // Joint frame: x axis points along world y. Shift 2 * 0.3 + 0.25 along it; then the child hangs 0.5 along
  // its -y.
  const double a = std::numbers::pi / 2 + 0.3;
  const Vector3d expected(1.0 + 0.5 * std::sin(a), 0.85 - 0.5 * std::cos(a), 0.0);
  EXPECT_LT((w.marker.col(0) - expected).norm(), 1e-15);
}

}  // namespace
}  // namespace kinemark::model
