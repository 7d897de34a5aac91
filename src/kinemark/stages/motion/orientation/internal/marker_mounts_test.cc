// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/marker_mounts.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Two sensors, of which the second one is on a body that markers hardly turn; their world is the model's but
/// for the heading.
struct TwoSensors {
  PosedSensors posed;
  data::Orientations recording;
  std::vector<MarkedTurn> turns;
  std::vector<std::int64_t> frames;
  Eigen::Matrix3d mount =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();

  TwoSensors(double heading, double noise, std::int64_t count, bool tilts) {
    posed.unplaced = true;
    posed.sensors = {{.column = 0, .body_idx = 0, .world_from_sensor = {}, .world_from_body = {}},
                     {.column = 1, .body_idx = 1, .world_from_sensor = {}, .world_from_body = {}}};
    recording.names = {"a", "b"};
    recording.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = count};
    Random random(8, 2);
    for (std::int64_t f = 0; f < count; ++f) {
      frames.push_back(f);
      const double t = static_cast<double>(f) / 100.0;
      const Eigen::Matrix3d body =
          (Eigen::AngleAxisd(0.3 * t, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(tilts ? 0.6 * std::sin(3.0 * t) : 0.0, Eigen::Vector3d::UnitZ()))
              .toRotationMatrix();
      turns.push_back({.world_from_body = body, .variance = 1e-6});
      turns.push_back({.world_from_body = body, .variance = 0.1});
      for (int s = 0; s < 2; ++s) {
        const Eigen::Vector3d v =
            noise * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
        const Eigen::Quaterniond q(Eigen::AngleAxisd(v.norm(), v.norm() > 0.0
                                                                   ? Eigen::Vector3d(v.normalized())
                                                                   : Eigen::Vector3d::UnitX()) *
                                   Eigen::AngleAxisd(-heading, Eigen::Vector3d::UnitY()) *
                                   Eigen::Quaterniond(Eigen::Matrix3d(body * mount)));
        recording.quaternion.insert(recording.quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
      }
    }
  }

  [[nodiscard]] MarkerMounts mounts() const { return {posed, recording, turns, frames}; }
};

TEST(MarkerMounts, FindHeadingAndPlace) {
  for (const double heading : {0.4, -2.9}) {
    const TwoSensors scene(heading, 1.0 * kDegree, 200, true);
    const auto mounts = scene.mounts();
    const auto found = mounts.find_heading();
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_NEAR(std::remainder(found->rad - heading, 2.0 * std::numbers::pi), 0.0, 3.0 * found->sd_rad);
    EXPECT_LT(found->sd_rad, 2.0 * kDegree);
    EXPECT_LT(
        Eigen::AngleAxisd(Eigen::Matrix3d(mounts.body_from_sensor(0, found->rad).transpose() * scene.mount))
            .angle(),
        1.0 * kDegree);
  }
}

TEST(MarkerMounts, OnlyBodiesThatMarkersTurnPlaceTheirSensors) {
  const TwoSensors thirty(0.4, 0.01, 30, true), nine(0.4, 0.01, 9, true);
  const auto many = thirty.mounts();
  EXPECT_TRUE(many.by_markers(0));
  EXPECT_FALSE(many.by_markers(1));
  const auto few = nine.mounts();
  EXPECT_FALSE(few.by_markers(0)) << "9 frames are too few";
  TwoSensors vague(0.4, 0.01, 30, true);
  for (auto& turn : vague.turns) turn.variance = 0.06 * 0.06;
  EXPECT_TRUE(vague.mounts().by_markers(0)) << "better than nothing";
  vague.posed.unplaced = false;
  EXPECT_FALSE(vague.mounts().by_markers(0)) << "a pose is better";
  EXPECT_NEAR(many.variance(0), (4e-4 + 1e-6) / 30.0, 1e-9);
  TwoSensors modelled(0.4, 0.01, 30, true);
  modelled.posed.by_model = true;
  EXPECT_FALSE(modelled.mounts().by_markers(0)) << "what the model says takes precedence";
}

TEST(MarkerMounts, ABodyThatTurnsAboutTheVerticalAloneLeavesTheHeadingOpen) {
  const TwoSensors scene(0.4, 1.0 * kDegree, 100, false);
  const auto found = scene.mounts().find_heading();
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("not determined"));
}

TEST(MarkerMounts, MarkersSayHowWellABodyIsTurned) {
  const auto model = model::Model::compile(testing_body::description()).value();
  auto markers = testing_body::record(model, 12);
  for (std::int64_t m = 10; m < 14; ++m)  // shank and kneecap
    for (std::int64_t f = 0; f < 12; ++f) markers.set_missing(f, m);
  const auto problem = make_problem(model, markers, {}).value();
  Eigen::MatrixXd states(model.state_count(), 12);
  for (std::int64_t f = 0; f < 12; ++f)
    states.col(f) = model::state_from_coordinates(model, testing_body::coordinates(model, f));
  PosedSensors posed;
  for (const int body : {0, 3, 4})
    posed.sensors.push_back({.column = 0, .body_idx = body, .world_from_sensor = {}, .world_from_body = {}});
  const Eigen::VectorXd information =
      Eigen::VectorXd::Constant(problem.model.marker_count(), 1.0 / (2e-3 * 2e-3));
  const auto turns = find_marked_turns(problem, markers, states, information, posed, {0, 7});
  ASSERT_EQ(turns.size(), 6U);
  for (const std::size_t i : {0U, 3U}) {
    EXPECT_GT(turns[i].variance, 1e-6);
    EXPECT_LT(turns[i].variance, 4e-4) << "a trunk with four markers";
    EXPECT_LT(turns[i + 1].variance, 4e-3) << "a thigh on a hinge";
    EXPECT_GT(turns[i + 2].variance, 1.0) << "a shank without markers";
  }
}

}  // namespace
}  // namespace kinemark::motion::internal
