// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// models/human.osim: its documented properties, and that it equals the output of its script.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::model {
namespace {

std::filesystem::path path() { return testing_support::project_folder() / "models" / "human.osim"; }

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Human : public ::testing::Test {
 protected:
  data::ModelDescription d = io::read_osim(path()).value();
  Model model = Model::compile(d).value();
  Workspace w{model};

  static std::string opposite(std::string name) {
    if (name.ends_with("_r")) return name.replace(name.size() - 1, 1, "l");
    if (name.starts_with("R")) return name.replace(0, 1, "L");
    return name;
  }
  static Vector3d mirrored(const Vector3d& p) { return {p.x(), p.y(), -p.z()}; }
};

TEST(HumanFile, IsWhatTheScriptWrites) {
  const testing_support::ScratchFolder scratch;
  const auto script = testing_support::project_folder() / "tools" / "human_model.py";
  const std::string command = "python3 '" + script.string() + "' '" + (scratch / "human.osim").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  EXPECT_EQ(content(path()), content(scratch / "human.osim"))
      << "run tools/human_model.py and commit what it writes";
}

TEST_F(Human, HasWhatWasPromised) {
  EXPECT_EQ(d.joints.size(), 26u);
  EXPECT_EQ(d.bodies.size(), 26u);
  EXPECT_EQ(d.coordinates.size(), 40u);
  EXPECT_EQ(d.markers.size(), 40u);
  EXPECT_TRUE(d.warnings.empty());
  EXPECT_EQ(model.free_joints().size(), 1u);
  EXPECT_EQ(model.speed_count(), 40);
  double mass = 0.0;
  for (const auto& body : d.bodies) mass += body.mass;
  EXPECT_NEAR(mass, 75.0, 1e-9);
  for (const char* name : {"pelvis_tilt", "pelvis_ty", "lumbar_extension", "neck_rotation", "arm_flex_r",
                           "elbow_flex_l", "pro_sup_r", "wrist_dev_l", "hip_flexion_r", "knee_angle_l",
                           "ankle_angle_r", "subtalar_angle_l", "mtp_angle_r"})
    EXPECT_GE(d.find_coordinate(name), 0) << name;
}

TEST_F(Human, SegmentMassesAreThoseOfTheTable) {
  const auto share = [&](std::initializer_list<const char*> names) {
    double mass = 0.0;
    for (const char* name : names) mass += d.bodies[static_cast<std::size_t>(d.find_body(name))].mass;
    return mass / 75.0;
  };
  EXPECT_NEAR(share({"pelvis", "abdomen", "thorax", "clavicle_r", "clavicle_l"}), 0.497, 1e-9);
  EXPECT_NEAR(share({"head"}), 0.081, 1e-9);
  EXPECT_NEAR(share({"humerus_r", "ulna_r", "radius_r", "hand_r", "fingers_r"}), 0.050, 1e-9);
  EXPECT_NEAR(share({"femur_l", "tibia_l", "talus_l", "calcn_l", "toes_l"}), 0.161, 1e-9);
}

TEST_F(Human, InertiasAreThoseOfRealBodies) {
  for (const auto& body : d.bodies) {
    const Vector3d p = Eigen::SelfAdjointEigenSolver<Matrix3d>(body.inertia_about_com).eigenvalues();
    EXPECT_GT(p[0], 0.0) << body.name;
    EXPECT_LE(p[2], (p[0] + p[1]) * (1.0 + 1e-9)) << body.name << ": no mass distribution has these moments";
  }
}

TEST_F(Human, StandsOnTheFloorAtItsHeight) {
  kinematics(model, w, model.default_state());
  const auto at = [&](const char* marker) { return Vector3d(w.marker.col(d.find_marker(marker))); };
  EXPECT_NEAR(at("RHEE").y(), 0.03, 0.03);
  EXPECT_NEAR(at("LTOE").y(), 0.03, 0.03);
  EXPECT_NEAR(at("LFHD").y(), 1.65, 0.05) << "a headband sits about 10 cm below the crown";
  EXPECT_GT(at("RTOE").x(), at("RHEE").x()) << "x is forward";
  EXPECT_GT(at("RASI").z(), 0.0) << "z is to the right";
  const double com_height = potential_energy(model, w) / (75.0 * 9.80665);
  EXPECT_NEAR(com_height / 1.75, 0.57, 0.02);
}

TEST_F(Human, LeftMirrorsRight) {
  const auto mirror_of = [&](const std::string& name) {
    return static_cast<std::size_t>(d.find_body(opposite(name)));
  };
  for (const auto& body : d.bodies) {
    const auto& other = d.bodies[mirror_of(body.name)];
    if (body.name.ends_with("_l")) continue;
    EXPECT_EQ(body.mass, other.mass) << body.name;
    EXPECT_LT((body.com_in_body - mirrored(other.com_in_body)).norm(), 1e-12) << body.name;
  }
  for (const auto& c : d.coordinates) {
    const auto& other = d.coordinates[static_cast<std::size_t>(d.find_coordinate(opposite(c.name)))];
    EXPECT_EQ(c.range_min, other.range_min) << c.name;
    EXPECT_EQ(c.range_max, other.range_max) << c.name;
  }
  // The same angles on both sides give mirrored markers.
  VectorXd q = VectorXd::Zero(40);
  for (int c = 6; c < 40; ++c) {
    const std::string& name = d.coordinates[static_cast<std::size_t>(c)].name;
    if (!name.ends_with("_r")) continue;
    q[c] = 0.05 * c - 0.7;
    q[d.find_coordinate(opposite(name))] = q[c];
  }
  q[d.find_coordinate("lumbar_extension")] = 0.3;
  kinematics(model, w, state_from_coordinates(model, q));
  int pairs = 0;
  for (const auto& marker : d.markers) {
    if (!marker.name.starts_with("R")) continue;
    ++pairs;
    const Vector3d right = w.marker.col(d.find_marker(marker.name)),
                   left = w.marker.col(d.find_marker(opposite(marker.name)));
    EXPECT_LT((right - mirrored(left)).norm(), 1e-11) << marker.name;
  }
  EXPECT_EQ(pairs, 18);
}

TEST_F(Human, CoordinatesTurnTheWayTheirNamesSay) {
  const auto moved = [&](const char* coordinate, const char* marker) {
    VectorXd q = VectorXd::Zero(40);
    kinematics(model, w, state_from_coordinates(model, q));
    const Vector3d before = w.marker.col(d.find_marker(marker));
    q[d.find_coordinate(coordinate)] = 0.3;
    kinematics(model, w, state_from_coordinates(model, q));
    return Vector3d(w.marker.col(d.find_marker(marker)) - before);
  };
  for (const char* side : {"r", "l"}) {
    const double out = *side == 'r' ? 1.0 : -1.0;
    const std::string c = std::string("_") + side, m = *side == 'r' ? "R" : "L";
    EXPECT_GT(moved(("hip_flexion" + c).c_str(), (m + "KNE").c_str()).x(), 0.05);
    EXPECT_LT(out * moved(("hip_adduction" + c).c_str(), (m + "KNE").c_str()).z(), -0.05);
    EXPECT_LT(out * moved(("hip_rotation" + c).c_str(), (m + "TOE").c_str()).z(), -0.02)
        << "positive is inwards";
    EXPECT_LT(moved(("knee_angle" + c).c_str(), (m + "ANK").c_str()).x(), -0.05) << "positive is flexion";
    EXPECT_GT(moved(("ankle_angle" + c).c_str(), (m + "TOE").c_str()).y(), 0.02)
        << "positive is dorsiflexion";
    EXPECT_GT(moved(("mtp_angle" + c).c_str(), (m + "TOE").c_str()).y(), 0.005);
    EXPECT_GT(moved(("arm_flex" + c).c_str(), (m + "ELB").c_str()).x(), 0.05);
    EXPECT_GT(moved(("elbow_flex" + c).c_str(), (m + "FIN").c_str()).x(), 0.05);
    EXPECT_GT(moved(("wrist_flex" + c).c_str(), (m + "FIN").c_str()).x(), 0.02);
    EXPECT_LT(out * moved(("wrist_dev" + c).c_str(), (m + "FIN").c_str()).z(), -0.02)
        << "positive is to the little finger";
  }
  EXPECT_LT(moved("lumbar_extension", "CLAV").x(), -0.05);
  EXPECT_GT(moved("lumbar_bending", "C7").z(), 0.05) << "positive is to the right";
}

TEST_F(Human, MarkersFixEveryCoordinate) {
  VectorXd q = VectorXd::Zero(40);
  for (const char* bent : {"elbow_flex_r", "elbow_flex_l", "knee_angle_r", "knee_angle_l"})
    q[d.find_coordinate(bent)] = 0.5;
  kinematics(model, w, state_from_coordinates(model, q));
  Eigen::MatrixXd J;
  marker_jacobian(model, w, J);
  const Eigen::MatrixXd C = (J.transpose() * J).llt().solve(Eigen::MatrixXd::Identity(40, 40));
  // Standard deviation per millimetre of marker noise: below 3 degrees everywhere.
  for (int c = 6; c < 40; ++c) {
    const int speed = model.coordinates()[static_cast<std::size_t>(c)].speed_idx;
    EXPECT_LT(1e-3 * std::sqrt(C(speed, speed)) * 57.3, 3.0)
        << d.coordinates[static_cast<std::size_t>(c)].name;
  }
}

}  // namespace
}  // namespace kinemark::model
