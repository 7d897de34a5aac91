// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report {
namespace {

using data::SampleState;
using internal::inflate_base64;
using internal::unpack_series;

/// Markers on circles; marker 1 is missing in frames 10 to 19, and rejected in frame 15.
data::Trajectories circling(std::int64_t frames, std::int64_t markers, double noise_m = 0.0) {
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < markers; ++m) names.push_back("M" + std::to_string(m));
  auto t = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .t0_s = 2.0, .frames = frames});
  Random random(5, 0);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < markers; ++m) {
      const double a = 0.02 * static_cast<double>(f) + static_cast<double>(m);
      t.state[t.index(f, m)] = SampleState::measured;
      t.x(f, m) = Eigen::Vector3d(std::cos(a), std::sin(a), 0.1 * static_cast<double>(m)) +
                  noise_m * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    }
  for (std::int64_t f = 10; f < std::min<std::int64_t>(20, frames) && markers > 1; ++f)
    t.set_missing(f, 1, f == 15 ? SampleState::rejected : SampleState::missing);
  return t;
}

TEST(Scene, HoldsEveryFrameOfAShortRecording) {
  const auto t = circling(50, 3);
  const auto json = scene_json({.markers = &t});
  EXPECT_EQ(json["frame_step"], 1);
  EXPECT_EQ(json["points"], 50);
  EXPECT_TRUE(json["worst"].is_null());
  const auto x = unpack_series(json["markers"]["positions_m"]);
  const auto states = inflate_base64(json["markers"]["states"].get<std::string>());
  ASSERT_EQ(x.size(), 3U * 3 * 50);
  ASSERT_EQ(states.size(), 150U);
  for (std::int64_t m = 0; m < 3; ++m)
    for (std::int64_t f = 0; f < 50; ++f) {
      const bool there = t.present(f, m);
      EXPECT_EQ(states[static_cast<std::size_t>(50 * m + f)] < 4, there);
      for (std::int64_t k = 0; k < 3 && there; ++k)
        EXPECT_NEAR(x[static_cast<std::size_t>(50 * (3 * m + k) + f)], t.x(f, m)[k], 2e-5);
    }
  EXPECT_EQ(states[50 + 15], 5) << "rejected";
  EXPECT_NEAR(x[50 * 3 + 12], t.x(9, 1)[0], 2e-5) << "the place where it was last";
}

TEST(Scene, ALongRecordingIsThinnedToTheBoundAndSaysSo) {
  const auto t = circling(30'000, 6, 0.003);
  const SceneOptions options{.max_bytes = 100'000, .max_bytes_long = 100'000};
  const auto json = scene_json({.markers = &t}, options);
  EXPECT_LE(json.dump().size(), 110'000U);
  EXPECT_GE(json.dump().size(), 40'000U) << "what there is room for is used";
  const auto step = json["frame_step"].get<std::int64_t>();
  ASSERT_GT(step, 1);
  const auto points = json["points"].get<std::int64_t>();
  EXPECT_EQ(points, (30'000 + step - 1) / step);
  const auto x = unpack_series(json["markers"]["positions_m"]);
  for (const std::int64_t p : {std::int64_t{0}, points / 2, points - 1})
    EXPECT_NEAR(x[static_cast<std::size_t>(p)], t.x(p * step, 0)[0], 5e-4) << "a point is a frame as it is";
  const auto worst = inflate_base64(json["worst"].get<std::string>());
  EXPECT_EQ(worst[static_cast<std::size_t>(points + 15 / step)], 5) << "no rejected frame is lost";
}

TEST(Scene, HoldsPlatesForcesModelAndWhatWasBefore) {
  const auto t = circling(40, 2);
  auto before = t;
  before.set_missing(3, 0);
  Array<double> model(t.x_in_world);
  for (double& v : model) v += 0.01;
  data::Wrenches forces{.time = t.time, .items = {}};
  auto& wrench = forces.items.emplace_back();
  wrench.name = "plate 1";
  for (int f = 0; f < 40; ++f)
    for (int k = 0; k < 3; ++k) {
      wrench.force.push_back(f == 7 ? kNaN : 10.0 * k);
      wrench.moment.push_back(0.0);
      wrench.point.push_back(0.5);
    }
  data::ForcePlate plate;
  plate.corners_in_world[2] = {1, 2, 3};
  const auto json = scene_json({.markers = &t,
                                .model = &model,
                                .before = &before,
                                .forces = &forces,
                                .plates = {plate},
                                .up = Eigen::Vector3d::UnitY(),
                                .up_from = "--up"});
  EXPECT_EQ(json["up"], (nlohmann::ordered_json{0.0, 1.0, 0.0}));
  EXPECT_EQ(json["up_from"], "--up");
  EXPECT_EQ(json["plates"][0]["corners_m"][2], (nlohmann::ordered_json{1.0, 2.0, 3.0}));
  EXPECT_NEAR(unpack_series(json["model_m"])[0], t.x(0, 0)[0] + 0.01, 2e-5);
  EXPECT_EQ(inflate_base64(json["before"]["states"].get<std::string>())[3], 4);
  const auto force = unpack_series(json["forces"][0]["force_n"]);
  EXPECT_NEAR(force[40 + 3], 10.0, 0.1);
  EXPECT_NEAR(force[40 + 7], 0.0, 0.1) << "no arrow where nothing was measured";
}

TEST(Scene, IsEmptyWithoutMarkersOrFrames) {
  const auto none = data::Trajectories::all_missing({}, {.rate_hz = 1.0, .t0_s = 0.0, .frames = 0});
  const auto json = scene_json({.markers = &none});
  EXPECT_EQ(json["points"], 0);
  EXPECT_TRUE(json["names"].empty());
}

TEST(Scene, TheSameSceneHasTheSameBytes) {
  const auto t = circling(3000, 5, 0.01);
  EXPECT_EQ(scene_json({.markers = &t}).dump(), scene_json({.markers = &t}).dump());
}

TEST(SceneOptions, AreChecked) {
  EXPECT_TRUE(SceneOptions{}.check());
  EXPECT_EQ((SceneOptions{.max_bytes = 10}.check().error().code), Code::usage);
  EXPECT_EQ((SceneOptions{.short_frames = -1}.check().error().code), Code::usage);
}

}  // namespace
}  // namespace kinemark::report
