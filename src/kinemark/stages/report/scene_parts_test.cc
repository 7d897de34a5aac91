// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/scene_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/missing.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report {
namespace {

using internal::inflate_base64;
using internal::unpack_series;

/// Two joints of one segment in 6 frames; the second is not placed in frame 2, and its covariance is unknown.
data::Skeleton two_joints() {
  data::Skeleton s;
  s.time = {.rate_hz = 50.0, .t0_s = 0.0, .frames = 6};
  s.joints.resize(2);
  s.joints[0].name = "elbow";
  s.joints[1].name = "wrist";
  s.lengths.push_back({.name = "elbow to wrist", .joint_a = 0, .joint_b = 1, .length_m = 0.3, .sd_m = 1e-3});
  s.allocate_centres();
  Eigen::Matrix3d root;
  root << 3.0, 0.0, 0.0, 1.0, 2.0, 0.0, -0.5, 0.25, 1.0;
  const Eigen::Matrix3d covariance = 1e-6 * root * root.transpose();
  for (std::int64_t f = 0; f < 6; ++f)
    for (std::int64_t j = 0; j < 2; ++j) {
      if (f == 2 && j == 1) continue;
      const std::size_t i = s.index(f, j);
      s.state[i] = data::CentreState::determined;
      for (std::size_t k = 0; k < 3; ++k)
        s.centre_in_world[3 * i + k] =
            0.1 * static_cast<double>(f) + static_cast<double>(j) + 0.01 * static_cast<double>(k);
      if (j == 1) continue;
      std::size_t k = 6 * i;
      for (int row = 0; row < 3; ++row)
        for (int column = row; column < 3; ++column) s.covariance[k++] = covariance(row, column);
    }
  return s;
}

TEST(SceneParts, CentresStatesAndRootsOfCovariancesComeBack) {
  const auto json = internal::skeleton_json(two_joints(), 1);
  EXPECT_EQ(json["names"], (nlohmann::ordered_json{"elbow", "wrist"}));
  EXPECT_EQ(json["links"], nlohmann::ordered_json::parse("[[0,1]]"));
  const auto centres = unpack_series(json["centres_m"]);
  ASSERT_EQ(centres.size(), 36U);
  EXPECT_NEAR(centres[6 * 1 + 4], 0.41, 2e-5) << "y of the elbow in frame 4";
  EXPECT_NEAR(centres[6 * 5 + 5], 1.52, 2e-5) << "z of the wrist in frame 5";
  const auto states = inflate_base64(json["states"].get<std::string>());
  ASSERT_EQ(states.size(), 12U);
  EXPECT_EQ(states[6 + 2], 0) << "undetermined";
  EXPECT_EQ(states[6 + 3], 3) << "determined";
  const auto roots = unpack_series(json["roots_mm"]);
  ASSERT_EQ(roots.size(), 72U);
  const std::array<double, 6> expected{3.0, 1.0, 2.0, -0.5, 0.25, 1.0};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(roots[6 * k + 3], expected[k], 6e-3);
    EXPECT_EQ(roots[36 + 6 * k + 3], 0.0) << "no ellipsoid where the covariance is unknown";
  }
}

TEST(SceneParts, EveryStepthFrameIsKept) {
  const auto json = internal::skeleton_json(two_joints(), 4);
  const auto centres = unpack_series(json["centres_m"]);
  ASSERT_EQ(centres.size(), 12U);
  EXPECT_NEAR(centres[1], 0.4, 2e-5);
}

TEST(SceneParts, CamerasStandWhereTheyStand) {
  SceneCamera camera{.name = "A", .centre_in_world = {1.0, 2.0, 3.0}, .nominal = true};
  camera.axes_in_world.col(2) = Eigen::Vector3d(0.0, 0.6, 0.8);
  const auto json = internal::cameras_json(std::vector{camera});
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["centre_m"], (nlohmann::ordered_json{1.0, 2.0, 3.0}));
  EXPECT_EQ(json[0]["forward"], (nlohmann::ordered_json{0.0, 0.6, 0.8}));
  EXPECT_EQ(json[0]["nominal"], true);
}

/// Two bodies over 5 frames; the second has a mesh and turns about z by a full turn, past the change of sign.
SceneBodies with_a_mesh() {
  SceneBodies bodies;
  bodies.names = {"plain", "bone"};
  bodies.mass_kg = {1.0, 0.0};
  bodies.meshes = {{},
                   {.points = {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}, {0.0, 0.0, 0.3}},
                    .triangles = {{0, 1, 2}, {3, 1, 0}}}};
  bodies.meshes_note = "1 body drawn from the model's meshes";
  for (int f = 0; f < 5; ++f) {
    bodies.origin_in_world.insert(bodies.origin_in_world.end(), {0.0, 0.0, 0.0, 0.5, 0.0, 0.1 * f});
    bodies.end_in_world.insert(bodies.end_in_world.end(), {0.3, 0.0, 0.0, 0.6, 0.0, 0.1 * f});
    const double half = 0.5 * (2.0 * std::numbers::pi / 4.0) * f;
    bodies.world_from_body.insert(bodies.world_from_body.end(), {1.0, 0.0, 0.0, 0.0});
    // The other of the two quaternions of the same turn, in every second frame.
    const double sign = f % 2 == 0 ? 1.0 : -1.0;
    bodies.world_from_body.insert(bodies.world_from_body.end(),
                                  {sign * std::cos(half), 0.0, 0.0, sign * std::sin(half)});
  }
  return bodies;
}

TEST(SceneParts, MeshesComeBackWithTheTurnsOfTheirBodies) {
  const auto json = internal::bodies_json(with_a_mesh(), 2);
  EXPECT_EQ(json["meshes_note"].get<std::string>(), "1 body drawn from the model's meshes");
  const auto& meshes = json["meshes"];
  EXPECT_EQ(meshes["body"], nlohmann::ordered_json::parse("[1]"));
  EXPECT_EQ(meshes["points"], nlohmann::ordered_json::parse("[4]"));
  EXPECT_EQ(meshes["triangles"], nlohmann::ordered_json::parse("[2]"));
  const auto positions = unpack_series(meshes["positions_m"]);
  ASSERT_EQ(positions.size(), 12U);
  EXPECT_NEAR(positions[1], 0.1, 1e-4) << "x of the second point";
  EXPECT_NEAR(positions[4 + 2], 0.2, 1e-4) << "y of the third";
  EXPECT_NEAR(positions[8 + 3], 0.3, 1e-4) << "z of the fourth";
  const auto corners = inflate_base64(meshes["corners"].get<std::string>());
  ASSERT_EQ(corners.size(), 12U);
  std::uint16_t word = 0;
  const std::vector<int> expected{0, 1, 2, 3, 1, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    word = static_cast<std::uint16_t>(word + corners[i] + 256 * corners[6 + i]);
    EXPECT_EQ(word, expected[i]) << i;
  }
  const auto turn = unpack_series(meshes["turn"]);
  ASSERT_EQ(turn.size(), 12U) << "frames 0, 2 and 4";
  EXPECT_NEAR(turn[0], 1.0, 3e-4);
  EXPECT_NEAR(turn[1], 0.0, 3e-4);
  EXPECT_NEAR(turn[9 + 1], 1.0, 3e-4) << "half a turn about z";
  EXPECT_NEAR(turn[2], -1.0, 3e-4) << "a whole turn goes on, it does not jump";
  const auto ends = unpack_series(json["end_m"]);
  EXPECT_NEAR(ends[0], 0.3, 5e-4) << "the plain body keeps its end";
  EXPECT_EQ(ends[9], 0.0) << "the other has none";
}

TEST(SceneParts, WithoutMeshesNothingIsAdded) {
  auto bodies = with_a_mesh();
  bodies.meshes.clear();
  bodies.world_from_body.clear();
  bodies.meshes_note.clear();
  const auto json = internal::bodies_json(bodies, 1);
  EXPECT_FALSE(json.contains("meshes") || json.contains("meshes_note"));
}

}  // namespace
}  // namespace kinemark::report
