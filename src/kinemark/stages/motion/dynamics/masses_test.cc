// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/masses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::motion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Kind = MassFault::Kind;

Matrix3d moments(double a, double b, double c) { return Vector3d(a, b, c).asDiagonal(); }

/// A shank of 3.6 kg, 0.4 m long, and a foot with markers.
data::ModelDescription leg() {
  data::ModelDescription m{.name = "leg"};
  m.bodies = {{.name = "shank",
               .mass = 3.6,
               .com_in_body = {0.0, -0.18, 0.0},
               .inertia_about_com = moments(0.05, 0.005, 0.051)},
              {.name = "foot",
               .mass = 1.1,
               .com_in_body = {0.1, 0.0, 0.0},
               .inertia_about_com = moments(0.0014, 0.0039, 0.0041)}};
  m.coordinates = {{.name = "knee"}, {.name = "ankle"}};
  m.joints = {
      {.name = "knee", .child_body_idx = 0, .axes = {{.axis = Vector3d::UnitZ(), .coordinate_idx = 0}}},
      {.name = "ankle",
       .parent_body_idx = 0,
       .child_body_idx = 1,
       .parent_from_joint = {.translation = {0.0, -0.4, 0.0}},
       .axes = {{.axis = Vector3d::UnitZ(), .coordinate_idx = 1}}}};
  m.markers = {{.name = "TOE", .body_idx = 1, .x_in_body = {0.2, -0.03, 0.0}}};
  return m;
}

std::vector<MassFault> faults_of(const data::ModelDescription& description) {
  return find_mass_faults(model::Model::compile(description).value());
}

TEST(Masses, OfALegAreThoseOfABody) { EXPECT_THAT(faults_of(leg()), IsEmpty()); }

TEST(Masses, ANegativeMomentIsFoundInAnyAxes) {
  auto model = leg();
  model.bodies[1].inertia_about_com = moments(0.004, 0.004, 0.004);
  model.bodies[1].inertia_about_com(0, 1) = model.bodies[1].inertia_about_com(1, 0) = 0.006;
  const auto faults = faults_of(model);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].kind, Kind::negative_moment);
  EXPECT_NEAR(faults[0].size, -0.002, 1e-12);
  EXPECT_TRUE(faults[0].matters);
  EXPECT_THAT(faults[0].sentence(), HasSubstr("body 'foot' has a negative moment of inertia, -0.002 kg m^2"));
}

TEST(Masses, AMomentAboveTheOtherTwoIsFoundWithWhetherItMatters) {
  auto model = leg();
  model.bodies[0].inertia_about_com = moments(0.01, 0.005, 0.1);
  auto faults = faults_of(model);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].kind, Kind::triangle);
  EXPECT_NEAR(faults[0].size, 0.085, 1e-12);
  EXPECT_TRUE(faults[0].matters);
  EXPECT_THAT(faults[0].sentence(),
              HasSubstr("'shank' has a moment of inertia that exceeds the other two together"));
  // Toes as many published models have them.
  model = leg();
  model.bodies[1].inertia_about_com = moments(0.0001, 0.0002, 0.0007);
  faults = faults_of(model);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_FALSE(faults[0].matters) << "less than a hundredth of the shank's";
  model.bodies[1].inertia_about_com = moments(0.0001, 0.0002, 0.0003000001);
  EXPECT_THAT(faults_of(model), IsEmpty()) << "a thin plate, rounded";
}

TEST(Masses, InertiaAndCentreMustLieWithinTheModel) {
  auto model = leg();
  model.bodies[1].mass = 1e-4;  // a massless link that was given an inertia of 1
  model.bodies[1].inertia_about_com = Matrix3d::Identity();
  auto faults = faults_of(model);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].kind, Kind::gyration);
  EXPECT_NEAR(faults[0].size, 100.0, 1e-9);
  EXPECT_TRUE(faults[0].matters);
  EXPECT_THAT(faults[0].sentence(),
              HasSubstr("inertia of body 'foot' is that of a mass 100 m from its centre"));
  model.bodies[1].mass = 1e-6;
  model.bodies[1].inertia_about_com = Matrix3d::Identity() * 1e-4;
  ASSERT_THAT(faults_of(model), SizeIs(1));
  EXPECT_FALSE(faults_of(model)[0].matters) << "no torque shows it";
  model = leg();
  model.bodies[0].com_in_body = {0.0, -180.0, 0.0};  // mm for m
  faults = faults_of(model);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].kind, Kind::centre);
  EXPECT_THAT(faults[0].sentence(), HasSubstr("mass centre of body 'shank' lies 180 m from its origin"));
  model = leg();
  model.bodies[0].mass = 0.0;
  EXPECT_THAT(faults_of(model), IsEmpty()) << "a body without mass has no centre to judge";
}

TEST(Masses, AllTogetherWeighLessThanWaterOfTheirSize) {
  auto model = leg();
  model.bodies[0].mass = 3600.0;  // g for kg
  model.bodies[0].inertia_about_com *= 1000.0;
  auto faults = faults_of(model);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].kind, Kind::mass);
  EXPECT_TRUE(faults[0].body.empty());
  EXPECT_THAT(faults[0].sentence(),
              HasSubstr("the bodies weigh 3601 kg; a ball of water twice as wide as the model"));
}

TEST(Masses, OfAModelWithoutExtentHaveNoSizeToFit) {
  data::ModelDescription one{.name = "one"};
  one.bodies = {{.name = "block", .mass = 70.0, .inertia_about_com = Matrix3d::Identity()}};
  one.coordinates = {{.name = "turn"}};
  one.joints = {
      {.name = "root", .child_body_idx = 0, .axes = {{.axis = Vector3d::UnitZ(), .coordinate_idx = 0}}}};
  EXPECT_THAT(faults_of(one), IsEmpty());
  one.bodies[0].inertia_about_com = moments(1.0, 1.0, 3.0);
  EXPECT_THAT(faults_of(one), SizeIs(1)) << "moments are judged alone";
}

}  // namespace
}  // namespace kinemark::motion
