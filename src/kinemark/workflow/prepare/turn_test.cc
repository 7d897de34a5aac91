// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/turn.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <limits>

namespace kinemark::workflow {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ParseAxis, SixNamesAndNoOther) {
  EXPECT_EQ(parse_axis("x").value(), Vector3d::UnitX());
  EXPECT_EQ(parse_axis("-z").value(), Vector3d(0.0, 0.0, -1.0));
  EXPECT_EQ(parse_axis("+Y").value(), Vector3d::UnitY());
  for (const char* bad : {"", "-", "w", "xy", "--x", "1"})
    EXPECT_EQ(parse_axis(bad).error().code, Code::usage) << bad;
}

TEST(NameOfDirection, IsTheAxisOrItsNumbers) {
  EXPECT_EQ(name_of_direction({0.0, 0.0, 2.0}), "z");
  EXPECT_EQ(name_of_direction({0.05, -1.0, 0.0}), "-y");
  EXPECT_EQ(name_of_direction({0.6, 0.8, 0.0}), "(0.60, 0.80, 0.00)");
}

TEST(ParseRotation, QuarterTurnsAreExact) {
  const Matrix3d R = parse_rotation("x -90").value();
  EXPECT_EQ(Vector3d(R * Vector3d::UnitZ()), Vector3d::UnitY());  // Z-up becomes Y-up
  EXPECT_EQ(Vector3d(R * Vector3d::UnitX()), Vector3d::UnitX());
  for (const double entry : R.reshaped()) EXPECT_TRUE(entry == 0.0 || entry == 1.0 || entry == -1.0) << entry;
}

TEST(ParseRotation, FollowOneAnotherAboutTheLaboratory) {
  EXPECT_EQ(parse_rotation("x 90 z 90").value(),
            Matrix3d(parse_rotation("z 90").value() * parse_rotation("x 90").value()));
  EXPECT_TRUE(parse_rotation("y 30 y -30").value().isIdentity(1e-15));
}

TEST(ParseRotation, RefusesWhatIsNone) {
  for (const char* bad : {"", "x", "90", "x ninety", "x -90 y", "x nan", "q 90", "x 720"})
    EXPECT_EQ(parse_rotation(bad).error().code, Code::usage) << bad;
}

TEST(RotationBetween, BringsEveryAxisToEveryOther) {
  const char* names[] = {"x", "y", "z", "-x", "-y", "-z"};
  for (const char* from : names)
    for (const char* to : names) {
      const Matrix3d R = rotation_between(parse_axis(from).value(), parse_axis(to).value());
      EXPECT_EQ(Vector3d(R * parse_axis(from).value()), parse_axis(to).value()) << from << " " << to;
      EXPECT_EQ(R.determinant(), 1.0);
    }
  EXPECT_EQ(rotation_between(Vector3d::UnitZ(), Vector3d::UnitY()), parse_rotation("x -90").value());
}

TEST(Turn, TakesAllOfATrialAlong) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 10.0, .frames = 1});
  trial.markers.x(0, 0) = Vector3d(0.1, 0.2, 0.3);
  trial.markers.state[0] = data::SampleState::measured;
  trial.markers.covariance = {1.0, 0.0, 0.0, 2.0, 0.5, 3.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0};
  trial.markers.unfiltered_in_world = {0.5, 0.6, 0.7, 0.1, 0.0, 0.2};
  trial.force_plates.emplace_back().corners_in_world[2] = Vector3d(1.0, 2.0, 3.0);
  trial.calibration_error.middle_in_world = Vector3d(1.0, 2.0, 3.0);
  turn(trial, parse_rotation("x -90").value());  // (x, y, z) becomes (x, z, -y)
  EXPECT_EQ(Vector3d(trial.markers.x(0, 0)), Vector3d(0.1, 0.3, -0.2));
  EXPECT_FALSE(trial.markers.x(0, 1).array().isFinite().any());
  EXPECT_EQ(Vector3d(trial.markers.unfiltered_in_world.data()), Vector3d(0.5, 0.7, -0.6));
  EXPECT_THAT(std::vector<double>(trial.markers.covariance.begin(), trial.markers.covariance.begin() + 6),
              ::testing::ElementsAre(1.0, 0.0, 0.0, 3.0, -0.5, 2.0));
  EXPECT_EQ(trial.force_plates[0].corners_in_world[2], Vector3d(1.0, 3.0, -2.0));
  EXPECT_EQ(trial.calibration_error.middle_in_world, Vector3d(1.0, 3.0, -2.0));
  EXPECT_EQ(trial.calibration_error.world_from_field, parse_rotation("x -90").value());
}

TEST(Turn, OfTheOutputsOfAModelOnlyPointsAreTurned) {
  using enum data::ChannelKind;
  data::Trial trial;
  trial.channels = {.names = {"LKneeAngles", "LHJC", "LHipForce"},
                    .kinds = {angle, modeled_marker, force},
                    .units = {"deg", "mm", "N"},
                    .rate_hz = 10.0,
                    .frames = 2,
                    .values = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18}};
  turn(trial, parse_rotation("x -90").value());
  EXPECT_THAT(trial.channels.values,
              ::testing::ElementsAre(1, 2, 3, 4, 6, -5, 7, 8, 9, 10, 11, 12, 13, 15, -14, 16, 17, 18));
  EXPECT_THAT(trial.warnings,
              ::testing::ElementsAre("forces and moments among the outputs of a model keep their axes"));
  data::Trial angles;
  angles.channels = {.names = {"LKneeAngles"},
                     .kinds = {angle},
                     .units = {"deg"},
                     .rate_hz = 10.0,
                     .frames = 1,
                     .values = {1, 2, 3}};
  turn(angles, parse_rotation("x -90").value());
  EXPECT_THAT(angles.warnings, Not(Contains(HasSubstr("forces and moments among the outputs"))));
}

TEST(Turn, WhatIsCarriedForOthersTurnsOrIsLeftOut) {
  const auto words = [](const char* text) {
    std::vector<std::byte> bytes;
    for (; *text != 0; ++text) bytes.push_back(static_cast<std::byte>(*text));
    return bytes;
  };
  data::Trial trial;
  trial.foreign = {
      {.name = "POINT",
       .parameters = {{.name = "X_SCREEN", .dims = {2}, .values = words("+X")},
                      {.name = "y_screen", .dims = {3}, .values = words("+Z ")},
                      {.name = "LAB_ROT", .type = 4, .dims = {}, .values = std::vector<std::byte>(4)},
                      {.name = "MOVIE_ID", .dims = {1}, .values = words("7")}}},
      {.name = "SUBJECTS", .parameters = {{.name = "ROTATION", .dims = {1}, .values = words("1")}}}};
  turn(trial, parse_rotation("x -90").value());
  ASSERT_EQ(trial.foreign[0].parameters.size(), 3U);
  EXPECT_EQ(trial.foreign[0].parameters[0].values, words("+X"));
  EXPECT_EQ(trial.foreign[0].parameters[1].values, words("+Y"));
  EXPECT_EQ(trial.foreign[0].parameters[1].dims, std::vector<std::uint8_t>{2});
  EXPECT_EQ(trial.foreign[0].parameters[2].name, "MOVIE_ID");
  EXPECT_EQ(trial.foreign[1].parameters.size(), 1U) << "not a place in the laboratory";
  EXPECT_THAT(trial.warnings,
              ::testing::ElementsAre("POINT:LAB_ROT is not true of a turned recording and is left out"));
  turn(trial, parse_rotation("x 30").value());
  ASSERT_EQ(trial.foreign[0].parameters.size(), 2U) << "a slanted screen has no name";
  EXPECT_EQ(trial.foreign[0].parameters[0].name, "X_SCREEN");
  data::Trial still;
  still.foreign = {
      {.name = "POINT",
       .parameters = {{.name = "LAB_ROT", .type = 4, .dims = {}, .values = std::vector<std::byte>(4)}}}};
  turn(still, Matrix3d::Identity());
  EXPECT_EQ(still.foreign[0].parameters.size(), 1U);
  EXPECT_THAT(still.warnings, Not(Contains(HasSubstr("is not true of a turned recording"))));
}

TEST(Turn, WrenchesKeepWhatTheyDo) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  data::Wrenches wrenches{.time = {.rate_hz = 10.0, .frames = 1},
                          .items = {{.name = "p",
                                     .body = "",
                                     .force = {0.0, 0.0, 700.0},
                                     .moment = {1.0, 2.0, 3.0},
                                     .point = {0.5, nan, 0.0}}}};
  turn(wrenches, parse_rotation("x -90").value());
  EXPECT_THAT(wrenches.items[0].force, ::testing::ElementsAre(0.0, 700.0, 0.0));
  EXPECT_THAT(wrenches.items[0].moment, ::testing::ElementsAre(1.0, 3.0, -2.0));
  EXPECT_EQ(wrenches.items[0].point[0], 0.5);
  EXPECT_EQ(wrenches.items[0].point[1], 0.0) << "an unknown coordinate does not spoil the others";
}

}  // namespace
}  // namespace kinemark::workflow
