// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/internal/smooth_markers.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using State = data::SampleState;

constexpr std::int64_t kPathFrames = 240;
constexpr double kPathRate_hz = 120.0;

Vector3d place_at(std::int64_t f) {
  const double t = static_cast<double>(f) / kPathRate_hz;
  return {0.3 * std::sin(5.0 * t), 0.1 * std::cos(9.0 * t), 1.0 + 0.4 * t};
}

data::Trajectories path_with(double noise_m, std::uint64_t seed) {
  auto out = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = kPathRate_hz, .frames = kPathFrames});
  Random random(seed, 3);
  for (std::int64_t f = 0; f < kPathFrames; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      out.x(f, m) = place_at(f) + noise_m * Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
      out.state[out.index(f, m)] = State::measured;
    }
  return out;
}

void hide(data::Trajectories& markers, std::int64_t m, std::int64_t first, std::int64_t end) {
  for (std::int64_t f = first; f < end; ++f) {
    markers.state[markers.index(f, m)] = State::missing;
    markers.x(f, m).setConstant(kNaN);
  }
}

// Root mean square distance from where the marker was, per axis, away from the ends.
double error_of(const data::Trajectories& paths, std::int64_t m, std::int64_t first = 20,
                std::int64_t end = kPathFrames - 20) {
  double sum = 0.0;
  for (std::int64_t f = first; f < end; ++f) sum += (Vector3d(paths.x(f, m)) - place_at(f)).squaredNorm();
  return std::sqrt(sum / (3.0 * static_cast<double>(end - first)));
}

TEST(SmoothMarkers, TakeNoiseOffAndKeepTheMovement) {
  for (std::uint64_t seed = 11; seed < 16; ++seed) {
    const auto markers = path_with(0.001, seed);
    const SmoothMarkers smooth(markers, {0, 1}, 0.0, nullptr, 1);
    EXPECT_LT(error_of(smooth.paths(), 0), 0.0006) << seed;
    EXPECT_GT(error_of(markers, 0), 0.0009) << seed;
  }
}

TEST(SmoothMarkers, LeaveAMarkerWithoutNoiseAsItIs) {
  auto markers = path_with(0.0, 1);
  // Straight at constant velocity: sixth differences are nothing but rounding.
  for (std::int64_t f = 0; f < kPathFrames; ++f) markers.x(f, 1) = Vector3d(1.0, 2.0, 3.0);
  const SmoothMarkers smooth(markers, {1}, 0.0, nullptr, 1);
  for (std::int64_t f = 0; f < kPathFrames; ++f)
    EXPECT_EQ((Vector3d(smooth.paths().x(f, 1)) - Vector3d(1.0, 2.0, 3.0)).norm(), 0.0);
  const auto again = smooth.refit(5, 0);
  EXPECT_EQ((Vector3d(again.x(100, 1)) - Vector3d(1.0, 2.0, 3.0)).norm(), 0.0);
}

TEST(SmoothMarkers, LeaveMarkersThatNobodyUsesAsTheyAre) {
  const auto markers = path_with(0.001, 2);
  const SmoothMarkers smooth(markers, {0}, 0.0, nullptr, 1);
  for (std::int64_t f = 0; f < kPathFrames; f += 17) {
    EXPECT_EQ((Vector3d(smooth.paths().x(f, 1)) - Vector3d(markers.x(f, 1))).norm(), 0.0);
    EXPECT_GT((Vector3d(smooth.paths().x(f, 0)) - Vector3d(markers.x(f, 0))).norm(), 0.0);
  }
}

TEST(SmoothMarkers, CrossGapsAndKeepTheirState) {
  auto markers = path_with(0.0005, 3);
  hide(markers, 0, 100, 112);
  const SmoothMarkers smooth(markers, {0, 1}, 0.0, nullptr, 1);
  EXPECT_LT(error_of(smooth.paths(), 0, 100, 112), 0.003);
  EXPECT_EQ(smooth.paths().state[smooth.paths().index(105, 0)], State::missing);
}

TEST(SmoothMarkers, FillGapsWithoutNoiseToo) {
  auto markers = path_with(0.0, 4);
  hide(markers, 0, 100, 104);
  const SmoothMarkers smooth(markers, {0}, 0.0, nullptr, 1);
  EXPECT_LT(error_of(smooth.paths(), 0, 100, 104), 0.0005);
}

TEST(SmoothMarkers, LeaveAMarkerWithFewSamplesAsItIs) {
  auto markers = path_with(0.001, 5);
  hide(markers, 0, 0, 215);
  const SmoothMarkers smooth(markers, {0}, 0.0, nullptr, 1);
  EXPECT_TRUE(std::isnan(smooth.paths().x(10, 0).x()));
  EXPECT_EQ((Vector3d(smooth.paths().x(230, 0)) - Vector3d(markers.x(230, 0))).norm(), 0.0);
}

TEST(SmoothMarkers, RefitsSpreadAsTheErrorDoes) {
  double squares = 0.0, spread = 0.0;
  std::int64_t count = 0;
  for (std::uint64_t seed = 21; seed < 29; ++seed) {
    const auto markers = path_with(0.001, seed);
    const SmoothMarkers smooth(markers, {0}, 0.0, nullptr, 1);
    for (std::int64_t k = 0; k < 20; ++k) {
      const auto again = smooth.refit(seed, k);
      for (std::int64_t f = 30; f < 210; f += 30) {
        spread += (Vector3d(again.x(f, 0)) - Vector3d(smooth.paths().x(f, 0))).squaredNorm() / 20.0;
        if (k > 0) continue;
        squares += (Vector3d(smooth.paths().x(f, 0)) - place_at(f)).squaredNorm();
        ++count;
      }
    }
  }
  EXPECT_GT(count, 40);
  EXPECT_NEAR(std::sqrt(spread / squares), 1.0, 0.25);
}

TEST(SmoothMarkers, RefitsDependOnSeedAndNumberAlone) {
  const auto markers = path_with(0.001, 6);
  const SmoothMarkers one(markers, {0, 1}, 0.0, nullptr, 1), two(markers, {0, 1}, 0.0, nullptr, 2);
  const auto at_frame = [](const data::Trajectories& t) -> Vector3d { return t.x(77, 0); };
  EXPECT_EQ(at_frame(one.refit(1, 4)), at_frame(two.refit(1, 4)));
  EXPECT_NE(at_frame(one.refit(1, 4)), at_frame(one.refit(1, 5)));
  EXPECT_NE(at_frame(one.refit(1, 4)), at_frame(one.refit(2, 4)));
  // Two markers have noise of their own.
  const auto again = one.refit(1, 4);
  EXPECT_GT((Vector3d(again.x(77, 0)) - Vector3d(one.paths().x(77, 0)) -
             (Vector3d(again.x(77, 1)) - Vector3d(one.paths().x(77, 1))))
                .norm(),
            1e-6);
}

TEST(SmoothMarkers, TakeNoiseThatIsStatedOrThatTheFileCarries) {
  auto markers = path_with(0.001, 7);
  const auto deviation = [](const SmoothMarkers& smooth) {
    double sum = 0.0;
    for (std::int64_t k = 0; k < 30; ++k)
      sum += (Vector3d(smooth.refit(1, k).x(120, 0)) - Vector3d(smooth.paths().x(120, 0))).squaredNorm();
    return std::sqrt(sum / 90.0);
  };
  const double found = deviation(SmoothMarkers(markers, {0}, 0.0, nullptr, 1));
  const double stated = deviation(SmoothMarkers(markers, {0}, 0.004, nullptr, 1));
  EXPECT_GT(stated, 1.5 * found);
  markers.covariance.assign(6 * markers.state.size(), 0.0);
  for (std::size_t i = 0; i < markers.state.size(); ++i)
    math::pack_symmetric3(Matrix3d(0.004 * 0.004 * Matrix3d::Identity()), &markers.covariance[6 * i]);
  EXPECT_NEAR(deviation(SmoothMarkers(markers, {0}, 0.0, nullptr, 1)), stated, 1e-12);
}

TEST(SmoothMarkers, RefitsCarryTheColourOfTheNoise) {
  const auto markers = path_with(0.001, 9);
  auto noise = MarkerNoise::find(markers, {0}, 1, 1);
  ASSERT_NE(noise.of(0), nullptr);
  const auto spread_of = [&](const MarkerNoise* of) {
    const SmoothMarkers smooth(markers, {0}, 0.0, of, 1);
    double squares = 0.0;
    for (std::int64_t k = 0; k < 20; ++k) {
      const auto refit = smooth.refit(1, k);
      for (std::int64_t f = 0; f < markers.frames(); ++f)
        squares += (refit.x(f, 0) - smooth.paths().x(f, 0)).squaredNorm();
    }
    return squares;
  };
  // White noise either way: the same spread, by other draws.
  EXPECT_NEAR(std::log(spread_of(&noise) / spread_of(nullptr)), 0.0, 0.2);
}

}  // namespace
}  // namespace kinemark::analysis::internal
