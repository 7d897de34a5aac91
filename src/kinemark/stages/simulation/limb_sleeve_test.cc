// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/simulation/internal/reach_path.h"
#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

Vector3d point(const Array<double>& values, std::int64_t index) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * index);
}

double seen_share(const LimbRecording& limb) {
  return 1.0 - static_cast<double>(limb.markers.count_missing()) /
                   static_cast<double>(limb.markers.frames() * limb.markers.markers());
}

TEST(SimulateSleeve, IsAnArmOfTwoStiffSegments) {
  SleeveOptions options;
  options.duration_s = 10.0;
  const auto limb = simulate_sleeve(options);
  ASSERT_TRUE(limb) << limb.error().message;
  ASSERT_TRUE(limb->markers.validate());
  ASSERT_TRUE(limb->layout.validate(16));
  EXPECT_EQ(limb->markers.frames(), 600);
  EXPECT_EQ(limb->markers.names[8], "f0");
  EXPECT_EQ(limb->layout.joints[0].name, "elbow");
  for (std::int64_t f = 0; f < 600; ++f) {
    const Vector3d elbow = point(limb->centre_in_world, f);
    EXPECT_NEAR(elbow.norm(), 0.150, 1e-12);
    for (int led = 0; led < 16; ++led) {
      const Vector3d position = limb->x_in_segment[led < 8 ? 0 : 1].col(led % 8);
      const Vector3d from = led < 8 ? Vector3d(Vector3d::Zero()) : elbow;
      EXPECT_NEAR((point(limb->x_true, 16 * f + led) - from).norm(), position.norm(), 1e-12);
    }
    EXPECT_NEAR((point(limb->x_true, 16 * f + 9) - point(limb->x_true, 16 * f + 14)).norm(),
                (limb->x_in_segment[1].col(1) - limb->x_in_segment[1].col(6)).norm(), 1e-12);
  }
}

TEST(SimulateSleeve, MovesSmoothlyAndWidely) {
  SleeveOptions options;
  options.duration_s = 30.0;
  const auto limb = simulate_sleeve(options).value();
  double fastest = 0.0, least = 4.0, most = 0.0;
  for (std::int64_t f = 1; f < limb.markers.frames(); ++f) {
    for (int led = 0; led < 16; ++led)
      fastest = std::max(
          fastest, 60.0 * (point(limb.x_true, 16 * f + led) - point(limb.x_true, 16 * f - 16 + led)).norm());
    const Vector3d elbow = point(limb.centre_in_world, f);
    // Markers 8 apart on the same side of the bone tell its direction: LED 0 of a segment lies along x.
    const Vector3d upper = point(limb.x_true, 16 * f + 7) - point(limb.x_true, 16 * f);
    const Vector3d lower = point(limb.x_true, 16 * f + 15) - point(limb.x_true, 16 * f + 8);
    EXPECT_GT(elbow.norm(), 0.1);
    const double angle = std::acos(upper.normalized().dot(lower.normalized()));
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  EXPECT_LT(fastest, 2.0);  // m/s
  EXPECT_GT(fastest, 0.3);
  EXPECT_GT(most - least, 0.8);  // rad of elbow flexion
}

TEST(SimulateSleeve, CamerasSeeAboutSixTenths) {
  SleeveOptions options;
  options.duration_s = 60.0;
  EXPECT_NEAR(seen_share(simulate_sleeve(options).value()), 0.58, 0.06);
  SleeveOptions hard = SleeveOptions::hard();
  hard.duration_s = 60.0;
  EXPECT_NEAR(seen_share(simulate_sleeve(hard).value()), 0.30, 0.05);
  options.line_of_sight = false;
  EXPECT_EQ(seen_share(simulate_sleeve(options).value()), 1.0);
  options.missing = 0.25;
  EXPECT_NEAR(seen_share(simulate_sleeve(options).value()), 0.75, 0.01);
}

TEST(SimulateSleeve, MoreIsLostNearTheMouth) {
  SleeveOptions options;
  options.duration_s = 120.0;
  const auto limb = simulate_sleeve(options).value();
  double near_seen = 0.0, near_all = 0.0, far_seen = 0.0, far_all = 0.0;
  const Vector3d mouth = internal::mouth_in_world();
  for (std::int64_t f = 0; f < limb.markers.frames(); ++f) {
    const Vector3d hand = point(limb.x_true, 16 * f + 15);
    const bool near = (hand - mouth).norm() < 0.05;
    for (int led = 12; led < 16; ++led)
      (near ? near_all : far_all) += 1.0,
          (near ? near_seen : far_seen) += limb.markers.present(f, led) ? 1.0 : 0.0;
  }
  ASSERT_GT(near_all, 1000.0);
  EXPECT_LT(near_seen / near_all, 0.7 * far_seen / far_all);
}

TEST(SimulateSleeve, ObstaclesHideMore) {
  SleeveOptions options;
  options.duration_s = 30.0;
  const auto open = simulate_sleeve(options).value();
  options.obstacles = true;
  const auto caged = simulate_sleeve(options).value();
  EXPECT_EQ(open.x_true, caged.x_true);
  EXPECT_LT(seen_share(caged), seen_share(open) - 0.05);
  EXPECT_GT(seen_share(caged), 0.2);
  for (std::size_t i = 0; i < open.markers.state.size(); ++i)
    if (open.markers.state[i] == data::SampleState::missing) {
      EXPECT_EQ(caged.markers.state[i], data::SampleState::missing);
    }
}

TEST(SimulateSleeve, ATipIsAtTheWristAndSeenLikeTheOthers) {
  const auto plain = simulate_sleeve({.duration_s = 20.0}).value();
  const auto limb = simulate_sleeve({.duration_s = 20.0, .tip = true}).value();
  ASSERT_EQ(limb.markers.markers(), 17);
  EXPECT_EQ(limb.markers.names.back(), "w0");
  EXPECT_EQ(limb.layout.segments[1].markers.back(), 16);
  EXPECT_TRUE(limb.layout.validate(17));
  ASSERT_EQ(limb.layout.ends.size(), 2U);
  EXPECT_EQ(limb.layout.ends[1].marker, 16);
  ASSERT_EQ(plain.layout.ends.size(), 1U) << "the shoulder stays in any case";
  EXPECT_TRUE(plain.layout.ends[0].stays());
  double seen = 0.0;
  for (std::int64_t f = 0; f < limb.markers.frames(); ++f) {
    EXPECT_LT((point(limb.x_true, 17 * f + 16) - point(limb.end_in_world, f)).norm(), 1e-12);
    EXPECT_EQ(point(limb.x_true, 17 * f + 3), point(plain.x_true, 16 * f + 3));
    seen += limb.markers.present(f, 16) ? 1.0 : 0.0;
  }
  EXPECT_GT(seen / static_cast<double>(limb.markers.frames()), 0.2);
  EXPECT_LT(seen / static_cast<double>(limb.markers.frames()), 0.95);
}

TEST(SimulateSleeve, SkinMovesLedsOnTheirBonesByWhatIsAsked) {
  const auto rigid = simulate_sleeve({.duration_s = 20.0, .tip = true}).value();
  const auto soft = simulate_sleeve({.duration_s = 20.0, .tip = true, .skin_m = 0.006}).value();
  EXPECT_EQ(rigid.end_in_world, soft.end_in_world);
  double most = 0.0;
  for (const int first : {0, 8}) {
    const int last = first == 0 ? 8 : 17;
    double squares = 0.0, n = 0.0;
    for (std::int64_t f = 0; f < rigid.markers.frames(); ++f)
      for (int led = first; led < last; ++led) {
        const double slid = (point(soft.x_true, 17 * f + led) - point(rigid.x_true, 17 * f + led)).norm();
        squares += slid * slid;
        most = std::max(most, slid);
        n += 1.0;
      }
    EXPECT_NEAR(std::sqrt(squares / n), 0.006, 1e-9) << first;
  }
  EXPECT_GT(most, 0.012) << "it goes with the posture";
  EXPECT_EQ(simulate_sleeve({.duration_s = 2.0, .tip = true, .skin_m = 0.0}).value().x_true,
            simulate_sleeve({.duration_s = 2.0, .tip = true}).value().x_true);
}

TEST(SimulateSleeve, SameSeedSameBits) {
  SleeveOptions options;
  options.duration_s = 3.0;
  const auto a = simulate_sleeve(options).value(), b = simulate_sleeve(options).value();
  EXPECT_EQ(a.x_true, b.x_true);
  EXPECT_EQ(a.markers.state, b.markers.state);
  options.seed = 2;
  EXPECT_NE(simulate_sleeve(options).value().x_true, a.x_true);
}

TEST(SimulateSleeve, RefusesWhatItCannotDraw) {
  const auto refused = [](auto change, const char* word) {
    SleeveOptions options;
    change(options);
    const auto limb = simulate_sleeve(options);
    ASSERT_FALSE(limb);
    EXPECT_EQ(limb.error().code, Code::usage);
    EXPECT_THAT(limb.error().message, HasSubstr(word));
  };
  refused([](SleeveOptions& o) { o.duration_s = -1.0; }, "duration_s");
  refused([](SleeveOptions& o) { o.duration_s = 1e9; }, "duration_s x rate_hz");
  refused([](SleeveOptions& o) { o.rate_hz = std::nan(""); }, "rate_hz");
  refused([](SleeveOptions& o) { o.leds_per_segment = 1; }, "leds_per_segment");
  refused([](SleeveOptions& o) { o.radius_m = 0.0; }, "radius_m");
  refused([](SleeveOptions& o) { o.sight_cosine = 2.0; }, "sight_cosine");
  refused([](SleeveOptions& o) { o.sight_cameras = 7; }, "sight_cameras");
  refused([](SleeveOptions& o) { o.mouth_loss = -0.1; }, "mouth_loss");
  refused([](SleeveOptions& o) { o.skin_m = -0.001; }, "skin_m");
}

}  // namespace
}  // namespace kinemark::simulation
