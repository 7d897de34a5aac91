// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Names and signs of the conventional gait model's moments, on a leg that stands under a known force.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/stages/analysis/kinetics/joint_loads.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kStandingFrames = 60;
constexpr double kBody_kg = 70.0;

// A leg upright, its joints within 10 mm of where they are said to be, its foot pitched by its markers: left
// with side 1, right with side -1. Its ankle is where `ankle` says.
data::Trajectories standing_leg(const std::string& s, double side, Vector3d& ankle) {
  const Vector3d pelvis(0.0, 0.0, 1.0), x = Vector3d::UnitX(), y = side * Vector3d::UnitY(),
                                        z = Vector3d::UnitZ();
  const Vector3d knee = pelvis + 0.09 * y - 0.5 * z - 0.08 * x;
  ankle = knee - 0.42 * z;
  const std::map<std::string, Vector3d> positions{{"LASI", pelvis + 0.12 * Vector3d::UnitY()},
                                                  {"RASI", pelvis - 0.12 * Vector3d::UnitY()},
                                                  {"LPSI", pelvis - 0.15 * x + 0.05 * Vector3d::UnitY()},
                                                  {"RPSI", pelvis - 0.15 * x - 0.05 * Vector3d::UnitY()},
                                                  {s + "THI", knee + 0.2 * z + 0.12 * y},
                                                  {s + "KNE", knee + 0.058 * y},
                                                  {s + "TIB", knee - 0.2 * z + 0.1 * y},
                                                  {s + "ANK", ankle + 0.042 * y},
                                                  {s + "HEE", ankle - 0.06 * x - 0.04 * z},
                                                  {s + "TOE", ankle + 0.14 * x - 0.04 * z}};
  std::vector<std::string> names;
  for (const auto& [name, position] : positions) names.push_back(name);
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = kStandingFrames});
  for (std::int64_t f = 0; f < kStandingFrames; ++f)
    for (const auto& [name, position] : positions) {
      const auto m = out.find(name);
      out.x(f, m) = position;
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

/// Moments in the middle frame, N m/kg, by name and label.
std::map<std::string, double> moments_under(const std::string& s, double side, const Vector3d& from_ankle,
                                            const Vector3d& force, double free_moment) {
  const auto definition = find_definition("pig").value();
  Vector3d ankle;
  const auto markers = standing_leg(s, side, ankle);
  data::Wrenches plates{.time = markers.time, .items = {}};
  data::Wrench plate{.name = "plate 1", .body = {}, .force = {}, .moment = {}, .point = {}};
  const Vector3d point = ankle + from_ankle;
  for (std::int64_t f = 0; f < kStandingFrames; ++f)
    for (Eigen::Index k = 0; k < 3; ++k) {
      plate.force.push_back(force[k]);
      plate.moment.push_back(k == 2 ? free_moment : 0.0);
      plate.point.push_back(point[k]);
    }
  plates.items.push_back(std::move(plate));
  const analysis::SegmentInput input{.markers = &markers,
                                     .given = {{"LLegLength", 0.9, "test"},
                                               {"RLegLength", 0.9, "test"},
                                               {s + "KneeWidth", 0.102, "test"},
                                               {s + "AnkleWidth", 0.07, "test"},
                                               {s + "StaticPlantFlex", 0.0, "test"},
                                               {s + "StaticRotOff", 0.0, "test"},
                                               {"Bodymass", kBody_kg, "test"}}};
  const auto loads = analysis::find_joint_loads(definition, input, plates, {.refits = 0});
  EXPECT_TRUE(loads) << loads.error().message;
  std::map<std::string, double> out;
  for (const auto& series : loads->series)
    for (std::size_t k = 0; k < series.labels.size(); ++k)
      out[series.name.substr(1) + "_" + series.labels[k]] = series.value[30 * series.size() + k];
  return out;
}

/// What the force alone does: without what the leg's own weight does.
double effect(const std::string& s, double side, const std::string& name, const Vector3d& from_ankle,
              const Vector3d& force, double free_moment = 0.0) {
  const Vector3d still(0.0, 0.0, 25.0);  // enough to be a contact
  const auto with = moments_under(s, side, from_ankle, force + still, free_moment);
  const auto without = moments_under(s, side, from_ankle, still, 0.0);
  return with.at(name) - without.at(name);
}

class PigMoments : public testing::TestWithParam<double> {
 protected:
  [[nodiscard]] static double side() { return GetParam(); }
  [[nodiscard]] static std::string letter() { return side() > 0.0 ? "L" : "R"; }
  [[nodiscard]] static Vector3d outwards() { return side() * Vector3d::UnitY(); }
};

TEST_P(PigMoments, ForceInFrontOfTheAnkleIsHeldByPlantarflexors) {
  const Vector3d point(0.1, 0.0, -0.07), up(0.0, 0.0, 700.0);
  EXPECT_NEAR(effect(letter(), side(), "AnkleMoment_plantarflexion", point, up), 0.1 * 700.0 / kBody_kg,
              0.15);
}

TEST_P(PigMoments, ForceOutsideOfTheAnkleIsHeldByInvertors) {
  const Vector3d point = 0.03 * outwards() - Vector3d(0.0, 0.0, 0.07), up(0.0, 0.0, 700.0);
  EXPECT_LT(effect(letter(), side(), "AnkleMoment_eversion", point, up), -0.2);
}

TEST_P(PigMoments, ForceBehindTheKneeIsHeldByExtensors) {
  const Vector3d point(-0.1, 0.0, -0.07), up(0.0, 0.0, 700.0);
  EXPECT_NEAR(effect(letter(), side(), "KneeMoment_extension", point, up), 0.1 * 700.0 / kBody_kg, 0.15);
}

TEST_P(PigMoments, ForceInsideOfHipAndKneeIsHeldByAbductorsAndWhatResistsVarus) {
  const Vector3d point = -0.06 * outwards() - Vector3d(0.0, 0.0, 0.07), up(0.0, 0.0, 700.0);
  EXPECT_GT(effect(letter(), side(), "HipMoment_abduction", point, up), 0.3);
  EXPECT_GT(effect(letter(), side(), "KneeMoment_valgus", point, up), 0.3);
}

TEST_P(PigMoments, ForceInFrontOfTheHipIsHeldByExtensors) {
  const Vector3d point(0.2, 0.0, -0.07), up(0.0, 0.0, 700.0);
  EXPECT_GT(effect(letter(), side(), "HipMoment_extension", point, up), 0.5);
}

TEST_P(PigMoments, FloorThatTurnsTheFootOutwardsIsHeldByInternalRotators) {
  const Vector3d point(0.0, 0.0, -0.07);
  for (const auto* joint :
       {"AnkleMoment_external_rotation", "KneeMoment_external_rotation", "HipMoment_external_rotation"})
    EXPECT_NEAR(effect(letter(), side(), joint, point, Vector3d::Zero(), side() * 14.0), -14.0 / kBody_kg,
                0.03)
        << joint;
}

TEST_P(PigMoments, WeightOnTheFootCompressesTheJoints) {
  const Vector3d point(0.0, 0.0, -0.07), up(0.0, 0.0, 700.0);
  EXPECT_NEAR(effect(letter(), side(), "KneeForce_tension", point, up), -10.0, 0.1);
  EXPECT_NEAR(effect(letter(), side(), "AnkleForce_compression", point, up), 10.0, 0.5);
  EXPECT_NEAR(effect(letter(), side(), "GroundReactionForce_z", point, up), 10.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(BothSides, PigMoments, testing::Values(1.0, -1.0));

}  // namespace
}  // namespace kinemark::pipeline
