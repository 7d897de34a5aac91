// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/vertical.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/workflow/prepare/turn.h"
#include "support/test_data.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;

model::Model human() { return model::Model::compile(pipeline::human_model().value()).value(); }

/// The human in its default posture, in every frame turned by R, in a recording of those of its markers that
/// `keep` wants.
data::Trial standing(const model::Model& model, const Eigen::Matrix3d& R,
                     bool (*keep)(const Vector3d&) = nullptr) {
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  std::vector<std::string> names;
  std::vector<Vector3d> points;
  for (int m = 0; m < model.marker_count(); ++m) {
    const Vector3d x = w.marker.col(m);
    if (keep != nullptr && !keep(x)) continue;
    names.push_back("Ann:" + model.description().markers[static_cast<std::size_t>(m)].name);
    points.push_back(R * x + Vector3d(1.0, 2.0, 0.0));
  }
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing(names, {.rate_hz = 10.0, .frames = 5});
  for (std::int64_t f = 0; f < 5; ++f)
    for (std::size_t m = 0; m < points.size(); ++m) {
      trial.markers.x(f, static_cast<std::int64_t>(m)) = points[m];
      trial.markers.state[trial.markers.index(f, static_cast<std::int64_t>(m))] = data::SampleState::measured;
    }
  return trial;
}

data::ForcePlate plate(const Vector3d& across, const Vector3d& along) {
  data::ForcePlate plate;
  plate.corners_in_world = {across + along, -across + along, -across - along, across - along};
  return plate;
}

TEST(VerticalOfBody, IsFoundInEveryAxis) {
  const auto model = human();
  const Vector3d up = -model.gravity().normalized();
  for (const char* axis : {"x", "y", "z", "-x", "-y", "-z"}) {
    const Vector3d wanted = parse_axis(axis).value();
    const auto trial = standing(model, rotation_between(up, wanted));
    const auto found = vertical_of_body(trial.markers, model);
    ASSERT_TRUE(found) << axis;
    EXPECT_EQ(found->up, wanted);
  }
}

TEST(VerticalOfBody, IsNotGuessedFromHalfABodyOrAnAskewOne) {
  const auto model = human();
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  const Vector3d up = -model.gravity().normalized();
  static double middle = 0.0;
  static Vector3d axis;
  axis = up;
  middle = standing(model, upright).markers.x(0, 0).dot(up);
  EXPECT_FALSE(vertical_of_body(
      standing(model, upright, [](const Vector3d& x) { return std::abs(x.dot(axis) - middle) < 0.3; })
          .markers,
      model));
  EXPECT_FALSE(vertical_of_body(standing(model, parse_rotation("x 45 z 45").value()).markers, model));
}

TEST(VerticalOfPlates, LiesAcrossThemTowardsTheBody) {
  data::Trial trial = standing(human(), Eigen::Matrix3d::Identity());
  for (auto& x : trial.markers.x_in_world) x += 3.0;  // above the plate along every axis
  EXPECT_FALSE(vertical_of_plates(trial)) << "no plates";
  trial.force_plates = {plate({0.3, 0.0, 0.0}, {0.0, 0.2, 0.0}), plate({0.3, 0.0, 0.0}, {0.0, -0.2, 0.0})};
  EXPECT_EQ(vertical_of_plates(trial)->up, Vector3d::UnitZ()) << "whatever the order of the corners";
  for (auto& x : trial.markers.x_in_world) x -= 20.0;
  EXPECT_EQ(vertical_of_plates(trial)->up, Vector3d(0.0, 0.0, -1.0));
  trial.force_plates.push_back(plate({0.3, 0.0, 0.0}, {0.0, 0.0, 0.2}));
  EXPECT_FALSE(vertical_of_plates(trial)) << "one of them is a wall";
}

TEST(VerticalOfScreen, IsNoneWhereTheRecordingSaysNothing) { EXPECT_FALSE(vertical_of_screen({})); }

TEST(VerticalOfScreen, TellsTheAxisOfARealFileUnlessItIsNegated) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto up = vertical_of_screen(io::read_markers(data / "btk-others/PiG_Motion3_FF.c3d").value());
  ASSERT_TRUE(up);
  EXPECT_EQ(up->up, Vector3d::UnitZ());
  EXPECT_EQ(up->from, "POINT:Y_SCREEN of the file");
  EXPECT_FALSE(vertical_of_screen(io::read_markers(data / "ezc3d-testFiles/Qualisys.c3d").value()))
      << "it says -Z; its plates and markers have z up";
}

}  // namespace
}  // namespace kinemark::workflow
