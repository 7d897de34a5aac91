// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/turning_model.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

TEST(TurningModel, TurnsAsTheModelAndHasNoLengths) {
  const auto description = testing_body::description();
  const Eigen::Matrix3d tilted =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto whole = model::Model::compile(description).value();
  const auto turning =
      model::Model::compile(turning_model(description, {{0, 4, tilted}}), {.free_roots = false}).value();
  const Eigen::VectorXd q = testing_body::coordinates(whole, 12);
  model::Workspace a(whole), b(turning);
  model::kinematics(whole, a, model::state_from_coordinates(whole, q));
  model::kinematics(turning, b, model::state_from_coordinates(turning, q));
  for (std::size_t i = 0; i < whole.bodies().size(); ++i) {
    EXPECT_TRUE(a.rotation[i].isApprox(b.rotation[i], 1e-12));
    EXPECT_LT(b.position[i].norm(), 1e-12);
  }
  ASSERT_EQ(turning.marker_count(), 3);
  for (std::size_t i = 0; i < turning.bodies().size(); ++i)
    if (turning.bodies()[i].description_idx == 4)
      EXPECT_TRUE(b.marker.isApprox(kAxis_m * b.rotation[i] * tilted, 1e-12));
}

TEST(TurningModel, KnowsWhatTurns) {
  const auto turns = turning_coordinates(testing_body::description());
  const std::vector<bool> expected{true, true, true, false, false, false, true,
                                   true, true, true, true,  true,  true};
  EXPECT_EQ(turns, expected);
}

TEST(TurningModel, AnglesOfTips) {
  for (const double angle : {0.0, 1e-4, 0.3, 2.0, 3.1}) {
    const Eigen::Matrix3d difference =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(2, -1, 1).normalized()).toRotationMatrix() -
        Eigen::Matrix3d::Identity();
    EXPECT_NEAR(angle_of_tips(kAxis_m * kAxis_m * difference.squaredNorm()), angle, 1e-9);
  }
}

TEST(TurningModel, RecordsTheTipsOfWhatIsThere) {
  data::Orientations recording{.names = {"a", "b"},
                               .time = {.rate_hz = 50.0, .t0_s = 1.0, .frames = 2, .first_number = 7},
                               .quaternion = Array<double>(16, 0.0),
                               .warnings = {}};
  for (std::size_t i = 0; i < 16; i += 4) recording.quaternion[i] = 1.0;
  for (std::size_t k = 12; k < 16; ++k) recording.quaternion[k] = std::numeric_limits<double>::quiet_NaN();
  const auto tips =
      record_tips(recording, {{1, 0, Eigen::Matrix3d::Identity()}}, Eigen::Matrix3d::Identity(), {0, 1});
  ASSERT_TRUE(tips.validate());
  EXPECT_EQ(tips.markers(), 3);
  EXPECT_TRUE(tips.x(0, 2).isApprox(Eigen::Vector3d(0, 0, kAxis_m)));
  EXPECT_FALSE(tips.present(1, 0));
  EXPECT_EQ(tips.time.number(0), 7);
}

}  // namespace
}  // namespace kinemark::motion::internal
