// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// A rigid person stands on force plates: the forces of the files must carry the weight to the newton.
#include "kinemark/workflow/motion/torques.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/io/c3d/writer.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/external_forces.h"
#include "kinemark/io/text/table_file.h"
#include "support/scratch.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;
using ::testing::_;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;

constexpr double kMass = 70.0, kGravity = 9.81, kRate = 100.0;
const Vector3d kPosition(0.4, -0.3, 0.9);  // of the mass centre

model::Model statue() {
  data::ModelDescription m;
  m.name = "statue";
  m.gravity = {0.0, 0.0, -kGravity};
  m.bodies.push_back({.name = "foot", .mass = kMass, .inertia_about_com = Eigen::Matrix3d::Identity()});
  data::JointDescription root{.name = "root", .child_body_idx = 0};
  const char* names[] = {"rx", "ry", "rz", "tx", "ty", "tz"};
  for (int c = 0; c < 6; ++c) {
    m.coordinates.push_back({.name = names[c], .is_rotation = c < 3});
    root.axes.push_back({.is_rotation = c < 3, .axis = Vector3d::Unit(c % 3), .coordinate_idx = c});
  }
  m.joints.push_back(root);
  return model::Model::compile(m).value();
}

data::JointMotion stand(const model::Model& model, std::int64_t frames) {
  data::JointMotion motion;
  motion.time = {.rate_hz = kRate, .t0_s = 0.5, .frames = frames};
  for (const auto& c : model.description().coordinates) {
    motion.coordinates.push_back(c.name);
    motion.is_rotation.push_back(c.is_rotation);
  }
  for (std::int64_t f = 0; f < frames; ++f) {
    motion.q.insert(motion.q.end(), {0.0, 0.0, 0.0});
    motion.q.insert(motion.q.end(), kPosition.data(), kPosition.data() + 3);
    motion.q.resize(static_cast<std::size_t>((f + 1) * model.coordinate_count()), 0.0);
  }
  motion.qd.assign(motion.q.size(), 0.0);
  motion.qdd.assign(motion.q.size(), 0.0);
  return motion;
}

/// A recording from 0 s whose one plate carries `weight` under the mass centre until 0.8 s.
void write_plate(const std::filesystem::path& path, double weight) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = kRate, .frames = 120});
  for (std::int64_t f = 0; f < 120; ++f) {
    trial.markers.x(f, 0) = kPosition;
    trial.markers.state[trial.markers.index(f, 0)] = data::SampleState::measured;
  }
  data::ForcePlate plate{.type = 2, .origin_in_plate = {0.0, 0.0, -0.05}, .channel_idx = {0, 1, 2, 3, 4, 5}};
  const Vector3d centre(0.35, -0.2, 0.0);
  const double corners[4][2] = {
      {0.2, -0.3}, {-0.2, -0.3}, {-0.2, 0.3}, {0.2, 0.3}};  // y and z of the plate turned
  for (std::size_t c = 0; c < 4; ++c)
    plate.corners_in_world[c] = centre + Vector3d(corners[c][0], corners[c][1], 0.0);
  trial.force_plates.push_back(plate);
  trial.analog.names = {"fx", "fy", "fz", "mx", "my", "mz"};
  trial.analog.units = {"N", "N", "N", "Nmm", "Nmm", "Nmm"};
  trial.analog.rate_hz = 10.0 * kRate;
  trial.analog.samples = 1200;
  for (int i = 0; i < 1200; ++i) {
    // In the plate: x as in the laboratory, y and z the other way round.
    const Vector3d force(0.0, 0.0, i < 800 ? -weight : 0.0),
        arm(kPosition.x() - centre.x(), centre.y() - kPosition.y(), -0.05);
    const Vector3d moment = 1e3 * arm.cross(force);
    trial.analog.values.insert(trial.analog.values.end(), force.data(), force.data() + 3);
    trial.analog.values.insert(trial.analog.values.end(), moment.data(), moment.data() + 3);
  }
  ASSERT_TRUE(io::write_c3d(path, trial));
}

/// Torques of the motion with the forces of a file.
Result<TorqueAccount> torques_with(const model::Model& model, data::JointMotion& motion,
                                   const std::filesystem::path& forces) {
  const auto read = io::read_external_forces(forces, motion.time, 20.0);
  if (!read) return std::unexpected(read.error());
  return add_torques(model, motion, &read->wrenches, {.error_bars = false});
}

TEST(Torques, APlateOfARecordingCarriesTheWeight) {
  const testing_support::ScratchFolder scratch;
  write_plate(scratch / "stand.c3d", kMass * kGravity);
  const auto model = statue();
  auto motion = stand(model, 20);  // 0.5 to 0.69 s
  const auto account = torques_with(model, motion, scratch / "stand.c3d").value();
  for (std::size_t i = 0; i < motion.tau.size(); ++i) EXPECT_NEAR(motion.tau[i], 0.0, 1e-3) << i;
  EXPECT_THAT(account.warnings, IsEmpty());
  EXPECT_THAT(account.facts,
              ElementsAre(Pair("force of plate 1", "on foot 0.500 to 0.690 s"),
                          Pair("forces not known for", "0.000 s (0 of 20 frames)"),
                          Pair("left to the root 'foot'", HasSubstr("N m RMS (body weight 687 N)"))));
  EXPECT_THAT(account.facts, Not(Contains(Pair(HasSubstr("' that no plate measures"), _))));
  for (const char* absent :
       {"the torques of its limb are not determined", "' has a residual of", "torques are without"})
    EXPECT_THAT(account.warnings, Not(Contains(HasSubstr(absent))));
}

TEST(Torques, AForceFarFromEveryFootIsSaidToBeSo) {
  const testing_support::ScratchFolder scratch;
  write_plate(scratch / "stand.c3d", kMass * kGravity);
  write_plate(scratch / "touch.c3d", 40.0);
  const auto model = statue();
  const auto warnings = [&](const char* file, double beside_m) {
    auto motion = stand(model, 20);
    for (std::size_t f = 0; f < 20; ++f) motion.q[6 * f + 3] += beside_m;
    return torques_with(model, motion, scratch / file).value().warnings;
  };
  EXPECT_THAT(
      warnings("stand.c3d", 2.0),
      Contains(HasSubstr("the force of 'plate 1' acts 2.00 m beside 'foot', the body nearest to it, from "
                         "0.500 to 0.690 s: somebody else on the plate")));
  EXPECT_THAT(warnings("stand.c3d", 0.3), Not(Contains(HasSubstr("', the body nearest to it, from"))));
  EXPECT_THAT(warnings("touch.c3d", 2.0), Not(Contains(HasSubstr("', the body nearest to it, from"))))
      << "of a small force it is not known where it acts";
}

/// A pelvis on two feet, 0.8 m apart along x, which carry the same weight; the right one stands below
/// kPosition.
model::Model two_feet() {
  data::ModelDescription m = statue().description();
  m.bodies[0] = {.name = "pelvis",
                 .mass = kMass - 2.0,
                 .com_in_body = {0.4, 0.0, 0.0},
                 .inertia_about_com = Eigen::Matrix3d::Identity()};
  for (const auto& [name, x] : {std::pair("foot_r", 0.0), std::pair("foot_l", 0.8)}) {
    const auto c = static_cast<int>(m.coordinates.size()), body = static_cast<int>(m.bodies.size());
    m.bodies.push_back({.name = name, .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity()});
    m.coordinates.push_back({.name = std::string("hip_") + name});
    m.joints.push_back({.name = std::string("joint_") + name,
                        .parent_body_idx = 0,
                        .child_body_idx = body,
                        .parent_from_joint = {Eigen::Matrix3d::Identity(), Vector3d(x, 0.0, -0.85)},
                        .axes = {{.axis = Vector3d::UnitY(), .coordinate_idx = c}}});
  }
  return model::Model::compile(m).value();
}

TEST(Torques, AFootThatStandsBesideThePlatesHasNoTorques) {
  const testing_support::ScratchFolder scratch;
  write_plate(scratch / "stand.c3d", 0.5 * kMass * kGravity);
  const auto model = two_feet();
  auto motion = stand(model, 20);
  const auto account = torques_with(model, motion, scratch / "stand.c3d").value();
  EXPECT_THAT(account.facts, Contains(Pair("load on 'foot_l' that no plate measures", "0.500 to 0.690 s")));
  EXPECT_THAT(account.warnings,
              Contains("'foot_l' bears up to 343 N that no plate measures for 0.200 s (20 of 20 frames): the "
                       "torques of its limb are not determined there and stand as nan"));
  EXPECT_TRUE(std::isnan(motion.tau[7]));
  EXPECT_TRUE(std::isfinite(motion.tau[6])) << "the right foot stands on the plate";
}

TEST(Torques, WhatNoPlateMeasuresIsSaid) {
  const testing_support::ScratchFolder scratch;
  write_plate(scratch / "stand.c3d", kMass * kGravity);
  const auto model = statue();
  auto motion = stand(model, 100);  // 0.5 to 1.49 s; the plate until 0.8 s, the file until 1.19 s
  const auto account = torques_with(model, motion, scratch / "stand.c3d").value();
  EXPECT_NEAR(motion.tau[6 * 10 + 5], 0.0, 1e-3);
  EXPECT_NEAR(motion.tau[6 * 50 + 5], kMass * kGravity, 1e-3);
  EXPECT_TRUE(std::isnan(motion.tau[6 * 80 + 5]));
  EXPECT_THAT(account.facts, Contains(Pair("forces not known for", "0.300 s (30 of 100 frames)")));
  EXPECT_THAT(account.warnings, Contains(HasSubstr("30 of 100 frames have no torques")));
  EXPECT_THAT(account.warnings, Contains(HasSubstr("with the given forces 'foot' has a residual of 5")));
}

TEST(Torques, WithoutAFileTheRootCarriesTheWeight) {
  const auto model = statue();
  auto motion = stand(model, 10);
  const auto account = add_torques(model, motion, nullptr, {.error_bars = false}).value();
  EXPECT_NEAR(motion.tau[5], kMass * kGravity, 1e-9);
  EXPECT_THAT(account.warnings,
              ElementsAre(HasSubstr("torques are without force plates: 'foot' is carried by 687 N")));
  EXPECT_THAT(account.warnings, ElementsAre(HasSubstr("so that the torques of limbs on the ground lack the "
                                                      "ground reaction")));
  EXPECT_THAT(account.facts, Not(Contains(Pair("forces not known for", _))));
}

TEST(Torques, AModelThatIsFixedToTheGroundLeavesNothingToARoot) {
  data::ModelDescription m;
  m.name = "pendulum";
  m.gravity = {0.0, 0.0, -kGravity};
  m.bodies.push_back({.name = "arm",
                      .mass = kMass,
                      .com_in_body = {0.3, 0.0, 0.0},
                      .inertia_about_com = Eigen::Matrix3d::Identity()});
  m.coordinates.push_back({.name = "swing"});
  m.joints.push_back(
      {.name = "pin", .child_body_idx = 0, .axes = {{.axis = Vector3d::UnitY(), .coordinate_idx = 0}}});
  const auto model = model::Model::compile(m).value();
  data::JointMotion motion;
  motion.time = {.rate_hz = kRate, .frames = 10};
  motion.coordinates = {"swing"};
  motion.is_rotation = {true};
  for (auto* values : {&motion.q, &motion.qd, &motion.qdd}) values->assign(10, 0.0);
  const auto account = add_torques(model, motion, nullptr, {.error_bars = false}).value();
  EXPECT_NEAR(std::abs(motion.tau[0]), 0.3 * kMass * kGravity, 1e-9);
  EXPECT_THAT(account.facts, Not(Contains(Pair(HasSubstr("left to the root '"), _))));
  EXPECT_THAT(account.facts, Not(Contains(Pair(_, HasSubstr("N m RMS (body weight")))));
  EXPECT_THAT(account.warnings, Not(Contains(HasSubstr("the torques of limbs on the ground lack"))));
}

TEST(Torques, ExternalLoadsOfOpenSimCarryTheWeightToo) {
  const testing_support::ScratchFolder scratch;
  data::Table table;
  table.columns = {"r_vx", "r_vy", "r_vz", "r_px", "r_py", "r_pz", "r_mx", "r_my", "r_mz"};
  for (int i = 0; i <= 20; ++i) {
    table.time_s.push_back(0.4 + 0.05 * i);
    // Away from the mass centre, with the moment that makes up for it.
    const Vector3d point = kPosition + Vector3d(0.1, -0.2, -0.9), force(0.0, 0.0, kMass * kGravity);
    const Vector3d moment = (kPosition - point).cross(force);
    for (const Vector3d& v : {force, point, moment})
      table.values.insert(table.values.end(), v.data(), v.data() + 3);
  }
  ASSERT_TRUE(io::write_table(scratch / "grf.sto", table));
  ASSERT_TRUE(io::write_text(
      scratch / "loads.xml",
      "<OpenSimDocument><ExternalLoads><objects><ExternalForce "
      "name=\"right\"><applied_to_body>foot</applied_to_body>"
      "<force_identifier>r_v</force_identifier><point_identifier>r_p</point_identifier><torque_identifier>r_m"
      "</torque_identifier></ExternalForce></objects><datafile>grf.sto</datafile></ExternalLoads></"
      "OpenSimDocument>",
      false));
  const auto model = statue();
  auto motion = stand(model, 20);
  const auto account = torques_with(model, motion, scratch / "loads.xml").value();
  for (std::size_t i = 0; i < motion.tau.size(); ++i) EXPECT_NEAR(motion.tau[i], 0.0, 1e-9) << i;
  EXPECT_THAT(account.facts, Contains(Pair("force of right", "on foot 0.500 to 0.690 s")));
}

/// A foot and a trunk 0.9 m along z from it.
model::Model two_bodies(const Vector3d& gravity) {
  data::ModelDescription description = statue().description();
  description.gravity = gravity;
  description.bodies[0].mass = 2.0;
  description.bodies.push_back(
      {.name = "trunk", .mass = kMass, .inertia_about_com = Eigen::Matrix3d::Identity()});
  description.joints.push_back({.name = "waist",
                                .parent_body_idx = 0,
                                .child_body_idx = 1,
                                .parent_from_joint = {Eigen::Matrix3d::Identity(), Vector3d(0.0, 0.0, 0.9)}});
  return model::Model::compile(description).value();
}

TEST(Torques, ABodyThatStandsAcrossGravityIsNoticedWithoutForces) {
  const auto standing = two_bodies({0.0, 0.0, -kGravity}), across = two_bodies({0.0, -kGravity, 0.0});
  auto motion = stand(standing, 10);
  const auto upright = add_torques(standing, motion, nullptr, {.error_bars = false}).value();
  EXPECT_THAT(upright.warnings, Not(Contains(HasSubstr("the body stands along"))));
  const auto sideways = add_torques(across, motion, nullptr, {.error_bars = false}).value();
  EXPECT_THAT(sideways.warnings,
              Contains(HasSubstr(
                  "the body stands along z on average, from its feet to its mass centre, and up in the "
                  "model is y")));
  const auto afloat = two_bodies(Vector3d::Zero());
  EXPECT_THAT(add_torques(afloat, motion, nullptr, {.error_bars = false}).value().warnings,
              Not(Contains(HasSubstr("the body stands along"))))
      << "without gravity nothing is up";
}

TEST(Torques, ABodyThatTheModelLacksIsNamed) {
  const auto model = statue();
  auto motion = stand(model, 10);
  data::Wrench push{.name = "a", .body = "tail"};
  for (auto* values : {&push.force, &push.moment, &push.point}) values->assign(30, 1.0);
  const data::Wrenches forces{.time = motion.time, .items = {push}};
  EXPECT_EQ(add_torques(model, motion, &forces, {.error_bars = false}).error().message,
            "wrench 'a' names body 'tail', which the model does not have");
}

TEST(Torques, OfMassesThatNoBodyHasMissAGate) {
  const auto sound = statue();
  auto motion = stand(sound, 40);
  const auto good = add_torques(sound, motion, nullptr, {}).value();
  ASSERT_EQ(good.gates.size(), 1U);
  EXPECT_TRUE(good.gates[0].passed);
  EXPECT_THAT(good.gates[0].sentence, HasSubstr("are those that bodies of its size can have"));
  EXPECT_THAT(good.gates[0].sentence, Not(HasSubstr("its torques are not those of a body")));
  for (const char* absent : {"; it is too small to show in the torques", "exceeds the other two together"})
    EXPECT_THAT(good.warnings, Not(Contains(HasSubstr(absent))));

  auto description = sound.description();
  description.bodies[0].inertia_about_com(2, 2) = 3.0;
  const auto odd = model::Model::compile(description).value();
  const auto bad = add_torques(odd, motion, nullptr, {}).value();
  ASSERT_EQ(bad.gates.size(), 1U);
  EXPECT_FALSE(bad.gates[0].passed);
  EXPECT_EQ(bad.gates[0].value, 1.0);
  EXPECT_THAT(bad.gates[0].sentence, HasSubstr("its torques are not those of a body"));
  EXPECT_THAT(bad.gates[0].sentence, Not(HasSubstr("are those that bodies of its size can have")));
  EXPECT_THAT(bad.warnings, Contains(HasSubstr("body 'foot' has a moment of inertia that exceeds")));

  description.bodies[0].inertia_about_com = Eigen::Matrix3d::Identity();
  description.bodies.push_back(
      {.name = "toe", .mass = 0.2, .inertia_about_com = Vector3d(0.0001, 0.0002, 0.001).asDiagonal()});
  description.joints.push_back({.name = "toe", .parent_body_idx = 0, .child_body_idx = 1});
  const auto small = add_torques(model::Model::compile(description).value(), motion, nullptr, {}).value();
  EXPECT_TRUE(small.gates[0].passed);
  EXPECT_THAT(small.warnings, Contains(HasSubstr("; it is too small to show in the torques")));
}

}  // namespace
}  // namespace kinemark::workflow
