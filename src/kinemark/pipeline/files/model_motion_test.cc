// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/model_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A thigh that swings about z at 1 m, a shank 0.4 m below that bends about z and slides along x.
data::ModelDescription leg() {
  data::ModelDescription leg{.name = "leg"};
  leg.bodies = {{.name = "thigh", .mass = 1.0}, {.name = "shank", .mass = 1.0, .com_in_body = {0, -0.2, 0}}};
  leg.coordinates = {{.name = "hip"}, {.name = "knee"}, {.name = "slide", .is_rotation = false}};
  const Vector3d z = Vector3d::UnitZ(), x = Vector3d::UnitX();
  leg.joints = {
      {.name = "hip",
       .parent_body_idx = -1,
       .child_body_idx = 0,
       .parent_from_joint = {.translation = {0, 1, 0}},
       .axes = {{.axis = z, .coordinate_idx = 0}}},
      {.name = "knee",
       .parent_body_idx = 0,
       .child_body_idx = 1,
       .parent_from_joint = {.translation = {0, -0.4, 0}},
       .axes = {{.is_rotation = false, .axis = x, .coordinate_idx = 2}, {.axis = z, .coordinate_idx = 1}}}};
  return leg;
}

data::Table table(std::vector<std::string> columns, std::vector<double> values) {
  data::Table out{.in_degrees = true, .columns = std::move(columns)};
  for (std::size_t r = 0; r < values.size() / out.columns.size(); ++r)
    out.time_s.push_back(0.5 + 0.01 * static_cast<double>(r));
  out.values.assign(values.begin(), values.end());
  return out;
}

TEST(MoveModel, PutsBodiesByDegreesAndMetres) {
  const auto motion = move_model(leg(), table({"slide", "knee", "hip"}, {0, 0, 0, 0.1, -90, 90})).value();
  EXPECT_THAT(motion.notes, IsEmpty());
  const auto& poses = motion.poses;
  ASSERT_TRUE(poses.validate());
  EXPECT_NEAR(poses.time.rate_hz, 100.0, 1e-9);
  EXPECT_EQ(poses.time.t0_s, 0.5);
  EXPECT_EQ(poses.bodies[1].parent, 0);
  EXPECT_LT((poses.pose(0, 1).translation - Vector3d(0, 0.6, 0)).norm(), 1e-12);
  // The thigh lies along x; the shank, slid along the thigh's x, hangs down again.
  EXPECT_LT((poses.pose(1, 1).translation - Vector3d(0.4, 1.1, 0)).norm(), 1e-12);
  EXPECT_LT((poses.pose(1, 1).rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(MoveModel, CellsWithoutANumberAreFilledAndCounted) {
  const auto motion = move_model(leg(), table({"hip", "knee", "slide"},
                                              {kNone, 0, 0, 10, 0, 0, kNone, 0, 0, 40, 0, 0, kNone, 0, 0}))
                          .value();
  EXPECT_THAT(motion.notes, ElementsAre("3 cells without a number were filled from those around them"));
  for (const auto& [frame, degrees] : {std::pair(0, 10.0), {1, 10.0}, {2, 25.0}, {3, 40.0}, {4, 40.0}}) {
    const auto& r = motion.poses.pose(frame, 0).rotation;
    EXPECT_NEAR(std::atan2(r(1, 0), r(0, 0)) * kDegPerRad, degrees, 1e-9) << frame;
  }
  EXPECT_THAT(move_model(leg(), table({"hip"}, {kNone, kNone})).error().message,
              HasSubstr("'hip' has no number in any row"));
}

TEST(MoveModel, CoordinatesWithoutAColumnKeepTheirDefault) {
  auto bent = leg();
  bent.coordinates[1].default_value = 0.5;
  const auto motion = move_model(bent, table({"hip", "other"}, {0, 1, 0, 2})).value();
  EXPECT_THAT(
      motion.notes,
      ElementsAre("2 coordinates of the model have no column and keep the default value: knee, slide"));
  EXPECT_NEAR(motion.poses.pose(1, 1).rotation(1, 0), std::sin(0.5), 1e-12);
  EXPECT_THAT(move_model(leg(), table({"other"}, {1, 2})).error().message,
              HasSubstr("none of its columns is a coordinate of model 'leg'"));
}

TEST(MoveModel, CoupledCoordinatesFollow) {
  auto coupled = leg();
  coupled.couplings = {{.name = "c",
                        .dependent_idx = 1,
                        .independent_idx = 0,
                        .function = math::ScalarFunction::linear(-1.0, 0.0)}};
  const auto motion = move_model(coupled, table({"hip", "knee", "slide"}, {30, 77, 0, 60, 77, 0})).value();
  EXPECT_LT((motion.poses.pose(1, 1).rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(MoveModel, AModelWithZUpIsTurned) {
  auto lying = leg();
  lying.gravity = {0, 0, -9.81};
  const auto motion = move_model(lying, table({"hip", "knee", "slide"}, {0, 0, 0, 0, 0, 0})).value();
  EXPECT_THAT(motion.notes, ElementsAre("the motion was turned: the model's up (z) became y"));
  EXPECT_LT((motion.poses.pose(0, 0).translation - Vector3d(0, 0, -1)).norm(), 1e-12);
  EXPECT_TRUE(motion.y_is_up);
}

TEST(MoveModel, WithoutGravityNothingIsUpAndNothingIsTurned) {
  const auto rest = table({"hip", "knee", "slide"}, {0, 0, 0, 0, 0, 0});
  auto afloat = leg();
  afloat.gravity.setZero();
  for (const auto& [model, known] : {std::pair(leg(), true), std::pair(afloat, false)}) {
    const auto motion = move_model(model, rest).value();
    EXPECT_EQ(motion.y_is_up, known);
    EXPECT_THAT(motion.notes, Not(Contains(HasSubstr("the motion was turned: the model's up"))));
    EXPECT_LT((motion.poses.pose(0, 0).translation - Vector3d(0, 1, 0)).norm(), 1e-12);
  }
}

TEST(MoveModel, ABodyEndsAtItsFarthestMarkerElseBeyondItsCentreOfMass) {
  auto marked = leg();
  const auto plain = table({"hip"}, {0, 0});
  EXPECT_EQ(move_model(marked, plain).value().poses.bodies[1].end_in_body, Vector3d(0, -0.4, 0));
  marked.markers = {{.name = "a", .body_idx = 1, .x_in_body = {0, -0.1, 0}},
                    {.name = "b", .body_idx = 1, .x_in_body = {0, -0.5, 0}}};
  EXPECT_EQ(move_model(marked, plain).value().poses.bodies[1].end_in_body, Vector3d(0, -0.5, 0));
}

TEST(MoveModel, RowsMustBeEvenlySpaced) {
  EXPECT_THAT(move_model(leg(), table({"hip"}, {0})).error().message,
              HasSubstr("holds 1 row; a motion needs two rows"));
  auto uneven = table({"hip"}, {0, 1, 2});
  uneven.time_s[1] += 0.003;
  EXPECT_THAT(move_model(leg(), uneven).error().message,
              HasSubstr("row 2 is at 0.513 s, 0.013 s after the one before; rows that are evenly spaced"));
}

TEST(ReadModelMotion, NamesTheFile) {
  const testing_support::ScratchFolder scratch;
  EXPECT_EQ(read_model_motion(scratch / "no.osim", scratch / "no.mot").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::pipeline
