// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/coordinate_rows.h"

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

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kBlank = std::numeric_limits<double>::quiet_NaN();

/// An angle and a length.
model::Model chain() {
  data::ModelDescription m{.name = "chain"};
  m.bodies = {{.name = "a", .mass = 1.0}, {.name = "b", .mass = 1.0}};
  m.coordinates = {{.name = "turn", .default_value = 0.2},
                   {.name = "slide", .is_rotation = false, .default_value = 0.5}};
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  m.joints = {{.name = "one", .child_body_idx = 0, .axes = {{.axis = x, .coordinate_idx = 0}}},
              {.name = "two",
               .parent_body_idx = 0,
               .child_body_idx = 1,
               .axes = {{.is_rotation = false, .axis = x, .coordinate_idx = 1}}}};
  return model::Model::compile(m).value();
}

data::Table rows(std::vector<std::string> columns, const std::vector<double>& values) {
  data::Table out{.in_degrees = true, .columns = std::move(columns)};
  for (std::size_t r = 0; r < values.size() / out.columns.size(); ++r)
    out.time_s.push_back(1.0 + 0.01 * static_cast<double>(r));
  out.values.assign(values.begin(), values.end());
  return out;
}

TEST(CoordinateRows, ColumnsInAnyOrderDegreesAndMetres) {
  const auto read =
      coordinate_rows(chain(), rows({"slide", "other", "turn"}, {0.1, 9, 90, 0.2, 9, -45})).value();
  EXPECT_NEAR(read.time.rate_hz, 100.0, 1e-9);
  EXPECT_EQ(read.time.t0_s, 1.0);
  EXPECT_EQ(read.time.frames, 2);
  EXPECT_NEAR(read.q[0][0], 90 * kRadPerDeg, 1e-15);
  EXPECT_EQ(read.q[1][1], 0.2);
  EXPECT_THAT(read.is_filled, ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(read.notes, IsEmpty());
  for (const char* absent : {"the default value:", "filled from those around them"})
    EXPECT_THAT(read.notes, Not(Contains(HasSubstr(absent))));
}

TEST(CoordinateRows, WhatIsBlankIsFilledAndMarked) {
  const auto read =
      coordinate_rows(chain(), rows({"turn", "slide"}, {kBlank, 1, 10, kBlank, 20, kBlank, kBlank, 4}))
          .value();
  EXPECT_NEAR(read.q[0][0], 10 * kRadPerDeg, 1e-15) << "the nearest at the beginning";
  EXPECT_NEAR(read.q[3][0], 20 * kRadPerDeg, 1e-15) << "and at the end";
  EXPECT_NEAR(read.q[1][1], 2.0, 1e-12) << "a straight line between";
  EXPECT_NEAR(read.q[2][1], 3.0, 1e-12);
  EXPECT_THAT(read.is_filled, ElementsAre(1, 0, 0, 1, 0, 1, 1, 0));
  EXPECT_THAT(read.notes, ElementsAre("4 cells without a number were filled from those around them"));
}

TEST(CoordinateRows, WhatIsAbsentKeepsItsDefault) {
  const auto read = coordinate_rows(chain(), rows({"turn"}, {1, 2})).value();
  EXPECT_EQ(read.q[1][1], 0.5);
  EXPECT_THAT(read.is_filled, ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(read.notes,
              ElementsAre(HasSubstr("1 coordinate of the model has no column and keeps the default "
                                    "value: slide")));
}

TEST(CoordinateRows, WhatIsAssumedIsMarkedUnlessItCannotMove) {
  const auto read = coordinate_rows(chain(), rows({"turn"}, {1, 2})).value();
  EXPECT_THAT(read.is_assumed, ElementsAre(false, true));
  auto description = chain().description();
  description.coordinates[1].locked = true;
  const auto locked = model::Model::compile(description).value();
  EXPECT_THAT(coordinate_rows(locked, rows({"turn"}, {1, 2})).value().is_assumed, ElementsAre(false, false));
}

TEST(CoordinateRows, APrescribedCoordinateNeedsNoColumn) {
  auto description = chain().description();
  description.coordinates[1].prescribed = math::ScalarFunction::linear(2.0, 0.5);
  const auto model = model::Model::compile(description).value();
  const auto read = coordinate_rows(model, rows({"turn"}, {1, 2})).value();
  EXPECT_DOUBLE_EQ(read.q[0][1], 0.5 + 2.0 * 1.0);
  EXPECT_DOUBLE_EQ(read.q[1][1], 0.5 + 2.0 * 1.01);
  EXPECT_THAT(read.is_assumed, ElementsAre(false, false));
  EXPECT_EQ(coordinate_rows(model, rows({"turn", "slide"}, {1, 0.3, 2, 0.4})).value().q[0][1], 0.3)
      << "what is written rules";
}

TEST(CoordinateRows, AColumnThatDoesNotFollowItsCouplingIsSaid) {
  auto description = chain().description();
  description.couplings.push_back({.name = "c",
                                   .dependent_idx = 1,
                                   .independent_idx = 0,
                                   .function = math::ScalarFunction::linear(0.5, 0.0)});
  const auto coupled = model::Model::compile(description).value();
  const double turn = 0.5 * kRadPerDeg;
  EXPECT_THAT(coordinate_rows(coupled, rows({"turn", "slide"}, {1, turn, 2, 2 * turn})).value().notes,
              Not(Contains(HasSubstr("' and follows it; its own column is up to"))));
  EXPECT_THAT(
      coordinate_rows(coupled, rows({"turn", "slide"}, {1, turn, 2, 0.3})).value().notes,
      ElementsAre(HasSubstr("'slide' is coupled to 'turn' and follows it; its own column is up to 0.283 m")));
}

TEST(CoordinateRows, AModelWithACouplingNeedsAColumnToo) {
  auto description = chain().description();
  description.couplings.push_back({.name = "c",
                                   .dependent_idx = 1,
                                   .independent_idx = 0,
                                   .function = math::ScalarFunction::linear(0.5, 0.0)});
  const auto coupled = model::Model::compile(description).value();
  const auto none = coordinate_rows(coupled, rows({"knee"}, {1, 2}));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("none of its columns is a coordinate of model 'chain'"));
  EXPECT_TRUE(coordinate_rows(coupled, rows({"turn"}, {1, 2})));
}

TEST(CoordinateRows, TimesMayBeRoundedToTheirDigits) {
  auto table = rows({"turn"}, {1, 2, 3, 4});
  table.time_s = {0.4, 0.417, 0.433, 0.45};  // 60 Hz, to the millisecond
  const auto read = coordinate_rows(chain(), table);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR(read->time.rate_hz, 60.0, 1e-9);
  table.time_s = {0.4, 0.417000001, 0.433, 0.45};
  EXPECT_FALSE(coordinate_rows(chain(), table)) << "these digits are not of rounding";
  table.time_s = {0.4, 0.42, 0.433, 0.45};
  EXPECT_FALSE(coordinate_rows(chain(), table)) << "3 ms off";
}

TEST(CoordinateRows, DegreesThatAreNotSaidAreNoticed) {
  auto table = rows({"turn", "slide"}, {30, 90, 60, 90});
  table.in_degrees = false;
  table.degrees_stated = false;
  EXPECT_THAT(coordinate_rows(chain(), table).value().notes,
              ElementsAre(HasSubstr("its angles were taken for radians")));
  table.values = {1, 90, 2, 90};
  EXPECT_THAT(coordinate_rows(chain(), table).value().notes,
              Not(Contains(HasSubstr("its angles were taken for radians"))))
      << "small angles; lengths do not count";
  table.values = {30, 1, 60, 1};
  table.degrees_stated = true;
  EXPECT_THAT(coordinate_rows(chain(), table).value().notes, IsEmpty()) << "the file says radians";
}

/// A chain of hinges; `range_rad` each way, or without limits.
model::Model hinges(int count, double range_rad) {
  data::ModelDescription m{.name = "hinges"};
  for (int i = 0; i < count; ++i) {
    const auto number = std::to_string(i);
    m.bodies.push_back({.name = "b" + number, .mass = 1.0});
    m.coordinates.push_back({.name = "q" + number});
    if (std::isfinite(range_rad))
      m.coordinates.back().range_min = -range_rad, m.coordinates.back().range_max = range_rad;
    m.joints.push_back({.name = "j" + number,
                        .parent_body_idx = i - 1,
                        .child_body_idx = i,
                        .axes = {{.axis = Eigen::Vector3d::UnitX(), .coordinate_idx = i}}});
  }
  return model::Model::compile(m).value();
}

TEST(CoordinateRows, DegreesCalledRadiansAreRefused) {
  const auto message = [](const model::Model& model, std::vector<double> last, bool in_degrees) {
    std::vector<std::string> names;
    std::vector<double> values(last.size(), 0.0);
    for (std::size_t i = 0; i < last.size(); ++i) names.push_back("q" + std::to_string(i));
    values.insert(values.end(), last.begin(), last.end());
    auto table = rows(names, values);
    table.in_degrees = in_degrees;
    const auto read = coordinate_rows(model, table);
    return read ? std::string() : read.error().message;
  };
  const auto limited = hinges(4, 2.0), open = hinges(4, kBlank);
  EXPECT_THAT(message(limited, {30, -60, 1, 1}, false),
              HasSubstr("says inDegrees=no, but 2 coordinates turn further than a body can, 'q0' to 30 rad"));
  EXPECT_THAT(message(open, {30, -60, 45, 20}, false), HasSubstr("4 coordinates turn further"));
  EXPECT_EQ(message(limited, {30, -60, 1, 1}, true), "");
  EXPECT_EQ(message(limited, {30, 1, 1, 1}, false), "") << "one may turn round and round";
  EXPECT_EQ(message(open, {30, -60, 45, 1}, false), "") << "so may a body about three axes";
  EXPECT_EQ(message(limited, {500, -600, 1, 1}, false), "") << "too far as degrees too";
  EXPECT_EQ(message(limited, {1.9, -1.9, 1, 1}, false), "");
}

TEST(CoordinateRows, WhatIsWrongIsOneSentence) {
  const auto refused = [](const data::Table& table) {
    const auto read = coordinate_rows(chain(), table);
    return read ? std::string() : read.error().message;
  };
  EXPECT_THAT(refused(rows({"turn"}, {1})), HasSubstr("holds 1 row; a motion needs two rows"));
  EXPECT_THAT(refused(rows({"knee"}, {1, 2})),
              HasSubstr("none of its columns is a coordinate of model 'chain'"));
  EXPECT_THAT(refused(rows({"turn", "slide"}, {1, kBlank, 2, kBlank})),
              HasSubstr("coordinate 'slide' has no number in any row"));
  EXPECT_THAT(refused(rows({"turn", "slide"}, {1, 2, 3, 1e300})),
              HasSubstr("row 2, column 'slide': 1e+300 is no"));
  auto hole = rows({"turn"}, {1, 2, 3, 4, 5, 6});
  for (std::size_t r = 4; r < 6; ++r) hole.time_s[r] += 0.2;
  EXPECT_THAT(refused(hole),
              HasSubstr("row 5 is at 1.24 s, 0.21 s after the one before; rows that are evenly "
                        "spaced are needed, here by 0.01 s"));
  auto rounded = rows({"turn"}, {1, 2, 3, 4});
  rounded.time_s = {0.4, 0.417, 0.433, 0.45};
  EXPECT_THAT(refused(rounded), Not(HasSubstr("rows that are evenly spaced are needed")));
  auto uneven = rows({"turn"}, {1, 2, 3, 4});
  uneven.time_s[2] += 0.003;
  EXPECT_THAT(refused(uneven), HasSubstr("row 3 is at 1.023 s, 0.013 s after the one before"));
}

}  // namespace

}  // namespace kinemark::pipeline
