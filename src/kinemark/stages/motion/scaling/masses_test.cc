// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/masses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;

data::ModelDescription bodies(const std::map<std::string, double>& masses) {
  data::ModelDescription model;
  for (const auto& [name, mass] : masses)
    model.bodies.push_back(
        {.name = name, .mass = mass, .inertia_about_com = 0.01 * mass * Eigen::Matrix3d::Identity()});
  return model;
}

double mass(const data::ModelDescription& model, const std::string& body) {
  return model.bodies[static_cast<std::size_t>(model.find_body(body))].mass;
}

double total(const data::ModelDescription& model) {
  double sum = 0.0;
  for (const auto& body : model.bodies) sum += body.mass;
  return sum;
}

const std::map<std::string, double> kWhole = {
    {"pelvis", 9},  {"torso", 20},  {"head", 5},     {"humerus_r", 2}, {"humerus_l", 2},
    {"ulna_r", 1},  {"ulna_l", 1},  {"radius_r", 3}, {"radius_l", 3},  {"hand_r", 1},
    {"hand_l", 1},  {"femur_r", 9}, {"femur_l", 9},  {"tibia_r", 4},   {"tibia_l", 4},
    {"talus_r", 1}, {"talus_l", 1}, {"calcn_r", 1},  {"calcn_l", 1}};

TEST(DistributeMass, a_whole_body_gets_dempsters_fractions) {
  auto model = bodies(kWhole);
  ASSERT_TRUE(distribute_mass(model, 80.0));
  EXPECT_NEAR(total(model), 80.0, 1e-12);
  EXPECT_NEAR(mass(model, "pelvis"), 80.0 * 0.142, 1e-12);
  EXPECT_NEAR(mass(model, "torso"), 80.0 * 0.355, 1e-12);
  EXPECT_NEAR(mass(model, "head"), 80.0 * 0.081, 1e-12);
  EXPECT_NEAR(mass(model, "femur_l"), 8.0, 1e-12);
  EXPECT_NEAR(mass(model, "tibia_r"), 80.0 * 0.0465, 1e-12);
}

TEST(DistributeMass, bodies_of_one_segment_keep_their_ratio) {
  auto model = bodies(kWhole);
  ASSERT_TRUE(distribute_mass(model, 80.0));
  EXPECT_NEAR(mass(model, "ulna_r"), 80.0 * 0.016 / 4.0, 1e-12);
  EXPECT_NEAR(mass(model, "radius_r"), 3.0 * mass(model, "ulna_r"), 1e-12);
  // Inertia follows the mass.
  const auto& radius = model.bodies[static_cast<std::size_t>(model.find_body("radius_r"))];
  EXPECT_NEAR(radius.inertia_about_com(0, 0), 0.01 * radius.mass, 1e-12);
}

TEST(DistributeMass, missing_segments_hand_their_share_to_their_neighbour) {
  auto model =
      bodies({{"pelvis", 1}, {"torso", 1}, {"femur_r", 1}, {"femur_l", 1}, {"tibia_r", 1}, {"tibia_l", 1}});
  ASSERT_TRUE(distribute_mass(model, 100.0));
  EXPECT_NEAR(mass(model, "torso"), 35.5 + 8.1 + 2.0 * (2.8 + 1.6 + 0.6), 1e-12);
  EXPECT_NEAR(mass(model, "tibia_r"), 4.65 + 1.45, 1e-12);
  EXPECT_NEAR(total(model), 100.0, 1e-12);
  auto half = bodies({{"torso", 1}});
  ASSERT_TRUE(distribute_mass(half, 70.0));
  EXPECT_NEAR(mass(half, "torso"), 70.0, 1e-12);
}

TEST(DistributeMass, massless_segments_get_theirs_and_other_bodies_keep_theirs) {
  auto model = bodies({{"pelvis", 0}, {"torso", 1}, {"backpack", 10}});
  ASSERT_TRUE(distribute_mass(model, 90.0));
  EXPECT_NEAR(mass(model, "backpack"), 10.0, 1e-12);
  EXPECT_NEAR(total(model), 90.0, 1e-12);
  EXPECT_GT(mass(model, "pelvis"), 0.0);
}

TEST(DistributeMass, a_limb_without_a_side_keeps_its_mass) {
  auto model = bodies({{"pelvis", 1}, {"torso", 1}, {"femur", 7}, {"tibia_r", 1}});
  ASSERT_TRUE(distribute_mass(model, 90.0));
  EXPECT_NEAR(mass(model, "femur"), 7.0, 1e-12);
  EXPECT_GT(mass(model, "tibia_r"), 0.0);
  EXPECT_NEAR(total(model), 90.0, 1e-12);
}

TEST(DistributeMass, mass_centres_of_long_bones_move_to_their_position) {
  auto model = testing_leg::leg();
  ASSERT_TRUE(distribute_mass(model, 70.0));
  // From the hip, 10 mm above the femur's origin, towards the knee.
  EXPECT_NEAR(model.bodies[1].com_in_body.y(), 0.01 - 0.433 * 0.41, 1e-12);
  EXPECT_NEAR(model.bodies[2].com_in_body.y(), -0.433 * 0.43, 1e-12);
  EXPECT_NEAR(model.bodies[0].com_in_body.x(), -0.07, 1e-12);
}

TEST(DistributeMass, refuses_what_it_cannot_distribute) {
  auto model = bodies({{"wing", 1}});
  EXPECT_THAT(distribute_mass(model, 70.0).error().message, HasSubstr("neither a pelvis nor a trunk"));
  model = bodies({{"pelvis", 1}, {"backpack", 10}});
  EXPECT_THAT(distribute_mass(model, 9.0).error().message, HasSubstr("need more than the 10 kg"));
  EXPECT_FALSE(distribute_mass(model, NAN));
}

}  // namespace
}  // namespace kinemark::motion
