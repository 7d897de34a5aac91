// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/subject.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/simulation/testing/models.h"

namespace kinemark::simulation {
namespace {

constexpr MotionKind kKinds[] = {MotionKind::walk, MotionKind::reach, MotionKind::tai_chi, MotionKind::mixed};

template <class T>
bool same_bits(const Array<T>& a, const Array<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool same_bits(const SimulatedSubject& a, const SimulatedSubject& b) {
  return same_bits(a.markers.x_in_world, b.markers.x_in_world) &&
         same_bits(a.markers.state, b.markers.state) &&
         same_bits(a.true_markers.x_in_world, b.true_markers.x_in_world) && same_bits(a.truth.q, b.truth.q) &&
         same_bits(a.truth.marker_error, b.truth.marker_error);
}

double coordinate(const SimulatedSubject& s, std::int64_t frame, std::string_view name) {
  return s.truth.q[s.truth.index(frame, s.truth.find(name))];
}

TEST(Subject, KinematicsOfTheTruthAreTheTrueMarkers) {
  for (const auto kind : kKinds) {
    const auto s = simulate_subject(human(), {.motion = kind, .duration_s = 2.0, .full_turns = 2.0}).value();
    ASSERT_TRUE(s.truth.validate());
    ASSERT_TRUE(s.true_markers.validate());
    ASSERT_TRUE(s.markers.validate());
    EXPECT_EQ(s.true_markers.count_missing(), 0);
    model::Workspace w(human());
    for (std::int64_t f = 0; f < s.truth.frames(); f += 7) {
      const Eigen::Map<const Eigen::VectorXd> q(s.truth.q.data() + s.truth.index(f, 0), s.truth.size());
      model::kinematics(human(), w, model::state_from_coordinates(human(), q));
      for (std::int64_t m = 0; m < s.true_markers.markers(); ++m)
        ASSERT_LT((s.true_markers.x(f, m) - w.marker.col(m)).norm(), 1e-12);
    }
  }
}

TEST(Subject, CoordinatesStayInsideTheirRanges) {
  for (const auto kind : kKinds)
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto s = simulate_subject(human(), {.motion = kind, .rate_hz = 20.0, .seed = seed}).value();
      for (std::int64_t c = 0; c < s.truth.size(); ++c) {
        const auto& described = human().description().coordinates[static_cast<std::size_t>(c)];
        if (!described.clamped) continue;
        const double margin = 0.04 * (described.range_max - described.range_min);
        for (std::int64_t f = 0; f < s.truth.frames(); ++f) {
          ASSERT_GT(s.truth.q[s.truth.index(f, c)], described.range_min + margin) << described.name;
          ASSERT_LT(s.truth.q[s.truth.index(f, c)], described.range_max - margin) << described.name;
        }
      }
    }
}

TEST(Subject, EveryCoordinateMovesAndSmoothly) {
  for (const auto kind : kKinds) {
    const auto s = simulate_subject(human(), {.motion = kind, .duration_s = 20.0, .rate_hz = 20.0}).value();
    for (std::int64_t c = 0; c < s.truth.size(); ++c) {
      double low = INFINITY, high = -INFINITY, roughest = 0.0;
      const auto q = [&](std::int64_t f) { return s.truth.q[s.truth.index(f, c)]; };
      for (std::int64_t f = 0; f < s.truth.frames(); ++f) {
        low = std::min(low, q(f));
        high = std::max(high, q(f));
        if (f > 1) roughest = std::max(roughest, std::abs(q(f) - 2.0 * q(f - 1) + q(f - 2)));
      }
      EXPECT_GT(high - low, 0.02) << s.truth.coordinates[static_cast<std::size_t>(c)];
      EXPECT_LT(roughest * 400.0, 60.0) << "rad/s^2, " << s.truth.coordinates[static_cast<std::size_t>(c)];
    }
  }
}

TEST(Subject, FullTurnsAreContinuousAndOfBothSigns) {
  for (const auto kind : {MotionKind::walk, MotionKind::mixed})
    for (const double rotations : {2.5, -3.0}) {
      const auto s =
          simulate_subject(human(),
                           {.motion = kind, .duration_s = 20.0, .rate_hz = 20.0, .full_turns = rotations})
              .value();
      const auto last = s.truth.frames() - 1;
      const double rotated = coordinate(s, last, "pelvis_rotation") - coordinate(s, 0, "pelvis_rotation");
      EXPECT_NEAR(rotated, 2.0 * std::numbers::pi * rotations, 0.8);
      for (std::int64_t f = 1; f <= last; ++f)
        ASSERT_LT(std::abs(coordinate(s, f, "pelvis_rotation") - coordinate(s, f - 1, "pelvis_rotation")),
                  0.1);
    }
}

TEST(Subject, WalksForwardsInACircle) {
  const auto s =
      simulate_subject(human(),
                       {.motion = MotionKind::walk, .duration_s = 20.0, .rate_hz = 10.0, .full_turns = 1.0})
          .value();
  double path = 0.0, forward = 0.0;
  const std::int64_t step = 6;
  for (std::int64_t f = step; f < s.truth.frames(); f += step) {
    const double dx = coordinate(s, f, "pelvis_tx") - coordinate(s, f - step, "pelvis_tx");
    const double dz = coordinate(s, f, "pelvis_tz") - coordinate(s, f - step, "pelvis_tz");
    // pelvis_rotation turns about y: forward is (cos, -sin) in x and z.
    const double heading = coordinate(s, f - step / 2, "pelvis_rotation");
    path += std::hypot(dx, dz);
    forward += dx * std::cos(heading) - dz * std::sin(heading);
  }
  EXPECT_NEAR(path, 2.0 * std::numbers::pi * 3.0, 3.0) << "a circle of 3 m radius";
  EXPECT_GT(forward, 0.9 * path);
}

TEST(Subject, NoiseHasTheSpreadAskedFor) {
  const auto s = simulate_subject(human(), {.noise_sd_m = 0.002}).value();
  double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0}, lag = 0.0;
  const std::int64_t n = s.markers.frames() * s.markers.markers();
  for (std::int64_t f = 0; f < s.markers.frames(); ++f)
    for (std::int64_t m = 0; m < s.markers.markers(); ++m) {
      const Eigen::Vector3d e = s.markers.x(f, m) - s.true_markers.x(f, m);
      for (int k = 0; k < 3; ++k) {
        sum[k] += e[k];
        square[k] += e[k] * e[k];
      }
      if (f > 0) lag += e.dot(s.markers.x(f - 1, m) - s.true_markers.x(f - 1, m)) / 3.0;
    }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(std::sqrt(square[k] / static_cast<double>(n)), 0.002, 0.002 * 0.02);
    EXPECT_NEAR(sum[k] / static_cast<double>(n), 0.0, 4.0 * 0.002 / std::sqrt(static_cast<double>(n)));
  }
  EXPECT_NEAR(lag / static_cast<double>(n) / 4e-6, 0.0, 0.02) << "one frame's noise says nothing of the next";
}

TEST(Subject, WithoutNoiseTheRecordingIsTheTruth) {
  const auto s = simulate_subject(human(), {.duration_s = 1.0, .noise_sd_m = 0.0}).value();
  EXPECT_TRUE(same_bits(s.markers.x_in_world, s.true_markers.x_in_world));
}

TEST(Subject, MarkerErrorIsRecordedMinusTrue) {
  const auto s =
      simulate_subject(human(), {.duration_s = 2.0, .soft_tissue = 1.0, .dropout_random = 0.2}).value();
  for (std::int64_t f = 0; f < s.markers.frames(); ++f)
    for (std::int64_t m = 0; m < s.markers.markers(); ++m)
      for (int k = 0; k < 3; ++k) {
        const double e = s.truth.marker_error[3 * s.markers.index(f, m) + static_cast<std::size_t>(k)];
        if (s.markers.present(f, m))
          ASSERT_EQ(e, s.markers.x(f, m)[k] - s.true_markers.x(f, m)[k]);
        else
          ASSERT_TRUE(std::isnan(e));
      }
}

TEST(Subject, SameSeedSameBitsForAnyNumberOfThreads) {
  const SubjectOptions options{.duration_s = 1.5,
                               .seed = 42,
                               .full_turns = 1.0,
                               .soft_tissue = 1.0,
                               .dropout_random = 0.1,
                               .dropout_sight = 0.1};
  const auto one = simulate_subject(human(), options).value();
  for (const int threads : {1, 3}) {
    SubjectOptions again = options;
    again.threads = threads;
    EXPECT_TRUE(same_bits(one, simulate_subject(human(), again).value())) << threads;
  }
}

TEST(Subject, SeedsDiffer) {
  const auto a = simulate_subject(human(), {.duration_s = 1.0, .seed = 1}).value();
  const auto b = simulate_subject(human(), {.duration_s = 1.0, .seed = 2}).value();
  EXPECT_FALSE(same_bits(a.truth.q, b.truth.q));
  EXPECT_FALSE(same_bits(a.markers.x_in_world, b.markers.x_in_world));
}

TEST(Subject, PartsKeepTheirValuesWhenOthersChange) {
  // Losing markers or adding soft tissue must not redraw the motion or the noise of what remains.
  const auto plain = simulate_subject(human(), {.duration_s = 1.0}).value();
  const auto lossy = simulate_subject(human(), {.duration_s = 1.0, .dropout_random = 0.3}).value();
  EXPECT_TRUE(same_bits(plain.truth.q, lossy.truth.q));
  for (std::int64_t f = 0; f < plain.markers.frames(); ++f)
    for (std::int64_t m = 0; m < plain.markers.markers(); ++m) {
      if (!lossy.markers.present(f, m)) continue;
      ASSERT_EQ(plain.markers.x(f, m), lossy.markers.x(f, m));
    }
}

TEST(Subject, MovesAnyModel) {
  const auto model = model::Model::compile(small_arm()).value();
  for (const auto kind : kKinds) {
    const auto s = simulate_subject(model, {.motion = kind,
                                            .duration_s = 4.0,
                                            .noise_sd_m = 0.0,
                                            .soft_tissue = 1.0,
                                            .dropout_random = 0.1,
                                            .dropout_sight = 0.1})
                       .value();
    ASSERT_TRUE(s.truth.validate());
    ASSERT_TRUE(s.markers.validate());
    for (std::int64_t f = 0; f < s.truth.frames(); ++f) {
      ASSERT_EQ(coordinate(s, f, "slide"), 0.02) << "locked";
      ASSERT_EQ(coordinate(s, f, "twist"), -0.5 * coordinate(s, f, "elbow") + 0.1) << "coupled";
      ASSERT_EQ(coordinate(s, f, "idle"), 0.0);
      if (!s.markers.present(f, 3)) continue;
      ASSERT_EQ(s.markers.x(f, 3), Eigen::Vector3d(0.5, 0.0, 0.5)) << "on the ground";
    }
  }
}

TEST(Subject, RefusesAModelWithoutMarkersAndBadOptions) {
  auto description = small_arm();
  description.markers.clear();
  const auto model = model::Model::compile(description).value();
  const auto none = simulate_subject(model);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_EQ(none.error().message,
            "the model \"arm\" has no markers; a simulated recording needs at least one");
  EXPECT_FALSE(simulate_subject(human(), {.noise_sd_m = NAN}));
}

TEST(Subject, OneFrameIsEnough) {
  const auto s =
      simulate_subject(human(), {.duration_s = 0.01, .soft_tissue = 1.0, .dropout_sight = 0.5}).value();
  EXPECT_EQ(s.markers.frames(), 1);
  EXPECT_EQ(s.markers.count_missing(), 20);
}

}  // namespace
}  // namespace kinemark::simulation
