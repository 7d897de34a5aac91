// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/given_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/io/text/table_file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A thigh and a shank on two hinges.
model::Model leg() {
  data::ModelDescription m;
  m.name = "leg";
  m.bodies = {{.name = "thigh", .mass = 8.0}, {.name = "foot_r", .mass = 4.0}};
  m.coordinates = {{.name = "hip"}, {.name = "knee", .default_value = 0.1}};
  m.joints = {
      {.name = "hip", .child_body_idx = 0, .axes = {{.axis = Eigen::Vector3d::UnitZ(), .coordinate_idx = 0}}},
      {.name = "knee",
       .parent_body_idx = 0,
       .child_body_idx = 1,
       .axes = {{.axis = Eigen::Vector3d::UnitZ(), .coordinate_idx = 1}}}};
  return model::Model::compile(m).value();
}

/// Ten rows of the hip from 1 s on, in degrees: 0, 1, 2, ...
data::Table hip_rows() {
  data::Table table{.columns = {"hip"}};
  table.in_degrees = true;
  for (int r = 0; r < 10; ++r) {
    table.time_s.push_back(1.0 + 0.01 * r);
    table.values.push_back(r);
  }
  return table;
}

/// 300 N upwards at the first second, 0 one second later.
data::Table falling_force() {
  data::Table table{.columns = {"ground_force_vx", "ground_force_vy", "ground_force_vz", "ground_force_px",
                                "ground_force_py", "ground_force_pz", "ground_torque_x", "ground_torque_y",
                                "ground_torque_z"}};
  table.time_s = {1.0, 2.0};
  table.values = {0, 300, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0};
  return table;
}

class ReadMotion : public ::testing::Test {
 protected:
  ReadMotion() { EXPECT_TRUE(io::write_table(scratch / "walk.mot", hip_rows())); }
  [[nodiscard]] Result<MotionOfFiles> read(const std::filesystem::path& forces = {}, double cutoff_hz = 0.0) {
    return read_motion(scratch / "walk.mot", forces, model, cutoff_hz);
  }
  static std::vector<std::string> roles(const MotionOfFiles& read) {
    std::vector<std::string> out;
    for (const auto& input : read.inputs) out.push_back(input.role);
    return out;
  }

  const testing_support::ScratchFolder scratch;
  const model::Model model = leg();
};

TEST_F(ReadMotion, ACoordinateWithoutAColumnIsAnAssumption) {
  const auto read_one = read().value();
  const auto& motion = read_one.given.motion;
  ASSERT_TRUE(motion.validate());
  EXPECT_THAT(motion.coordinates, ElementsAre("hip", "knee"));
  EXPECT_DOUBLE_EQ(motion.time.t0_s, 1.0);
  for (std::int64_t f = 0; f < 10; ++f) {
    EXPECT_NEAR(motion.q[motion.index(f, 0)], static_cast<double>(f) * kRadPerDeg, 1e-12);
    EXPECT_EQ(motion.q[motion.index(f, 1)], 0.1);
    EXPECT_EQ(motion.determined[motion.index(f, 0)], 1);
    EXPECT_EQ(motion.determined[motion.index(f, 1)], 0);
  }
  EXPECT_THAT(read_one.notes, Contains(HasSubstr("has no column and keeps the default value: knee")));
  EXPECT_THAT(roles(read_one), ElementsAre("motion"));
  EXPECT_THAT(motion.q_sd, IsEmpty());
  EXPECT_FALSE(read_one.given.forces);
  const auto& names = read_one.given.names;
  EXPECT_EQ(names.motion, (scratch / "walk.mot").string());
  EXPECT_EQ(names.no_deviations, "no standard deviations lie beside walk.mot (walk_sd.sto)");
}

TEST_F(ReadMotion, WhatItHasNoNumberOfIsMarked) {
  auto holes = hip_rows();
  holes.values[4] = kNaN;
  ASSERT_TRUE(io::write_table(scratch / "walk.mot", holes, {.force = true}));
  const auto with_hole = read().value();
  const auto& given = with_hole.given;
  EXPECT_NEAR(given.motion.q[given.motion.index(4, 0)], 4.0 * kRadPerDeg, 1e-12) << "between its neighbours";
  EXPECT_EQ(given.is_filled[given.motion.index(4, 0)], 1);
  EXPECT_EQ(std::ranges::count(given.is_filled, 1), 1);
}

TEST_F(ReadMotion, DeviationsBesideItUnlessItIsLowPassed) {
  auto sd = hip_rows();
  std::ranges::fill(sd.values, 0.5);
  sd.values[2] = kNaN;
  ASSERT_TRUE(io::write_table(scratch / "walk_sd.sto", sd));
  const auto with = read().value();
  const auto& motion = with.given.motion;
  EXPECT_THAT(roles(with), ElementsAre("motion", "deviations"));
  EXPECT_THAT(motion.q_sd[motion.index(1, 0)], DoubleEq(0.5 * kRadPerDeg));
  EXPECT_TRUE(std::isnan(motion.q_sd[motion.index(2, 0)]));
  EXPECT_EQ(motion.q_sd[motion.index(1, 1)], 0.0) << "what is assumed has no noise";
  const auto passed = read({}, 6.0).value();
  EXPECT_THAT(roles(passed), ElementsAre("motion"));
  EXPECT_THAT(passed.given.motion.q_sd, IsEmpty());
  sd.time_s.back() += 0.001;
  ASSERT_TRUE(io::write_table(scratch / "walk_sd.sto", sd, {.force = true}));
  EXPECT_THAT(read().error().message, HasSubstr("walk_sd.sto: has other columns or rows than walk.mot"));
}

TEST_F(ReadMotion, ForcesComeOnItsRows) {
  ASSERT_TRUE(io::write_table(scratch / "grf.sto", falling_force()));
  const auto with = read(scratch / "grf.sto").value();
  ASSERT_TRUE(with.given.forces);
  EXPECT_EQ(with.given.forces->frames(), 10);
  EXPECT_NEAR(with.given.forces->items.at(0).force[3 * 5 + 1], 300.0 * 0.95, 1e-9);
  EXPECT_THAT(roles(with), ElementsAre("motion", "forces"));
  EXPECT_EQ(with.given.names.forces, (scratch / "grf.sto").string());
  EXPECT_EQ(read(scratch / "none.sto").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::pipeline
