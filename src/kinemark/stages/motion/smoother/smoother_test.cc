// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/smoother.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kFrames = 200;
constexpr double kNoise_m = 0.002;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

double truth(const model::Model& model, std::int64_t f, int c) {
  return testing_body::coordinates(model, f)[c];
}

/// Root mean square error of the angles, rad.
double angle_rms(const model::Model& model, const data::JointMotion& motion, std::int64_t first = 0,
                 std::int64_t last = kFrames) {
  double squares = 0.0;
  int count = 0;
  for (std::int64_t f = first; f < last; ++f)
    for (int c = 0; c < motion.size(); ++c) {
      if (!motion.is_rotation[static_cast<std::size_t>(c)]) continue;
      squares += std::pow(motion.q[motion.index(f, c)] - truth(model, f, c), 2);
      ++count;
    }
  return std::sqrt(squares / count);
}

struct Coverage {
  double one = 0.0, two = 0.0;
};

Coverage coverage(const model::Model& model, const data::JointMotion& motion) {
  Coverage sums;
  double count = 0.0;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (int c = 0; c < motion.size(); ++c) {
      const auto i = motion.index(f, c);
      if (!motion.determined[i]) continue;
      const double z = std::abs(motion.q[i] - truth(model, f, c)) / motion.q_sd[i];
      sums.one += z < 1.0;
      sums.two += z < 2.0;
      count += 1.0;
    }
  return {sums.one / count, sums.two / count};
}

TEST(Smoother, HalvesTheErrorOfLeastSquaresAndItsBarsCover) {
  const auto model = body();
  const auto markers = testing_body::record(model, kFrames, kNoise_m, 1);
  const auto least_squares = solve_ik(model, markers).value();
  const auto smooth = smooth_motion(model, markers).value();
  EXPECT_TRUE(smooth.converged);
  EXPECT_LE(smooth.iterations, 5);
  EXPECT_LT(angle_rms(model, smooth.motion), 0.5 * angle_rms(model, least_squares.motion));
  const auto covers = coverage(model, smooth.motion);
  EXPECT_GT(covers.one, 0.60);
  EXPECT_LT(covers.one, 0.82);
  EXPECT_GT(covers.two, 0.91);
  EXPECT_TRUE(smooth.motion.validate());
}

/// Angles like those of walks, whose spectrum rises no further below 2.5 Hz; shoulder and elbow move against
/// each other. Coordinates x frames.
Eigen::MatrixXd walk_like(const model::Model& model, std::uint64_t seed) {
  constexpr int kBefore = 200;
  const double kept = std::exp(-2.0 * M_PI * 2.5 / 100.0);
  Random random(seed, 5);
  Eigen::MatrixXd q(model.coordinate_count(), kFrames);
  for (int c = 0; c < 12; ++c) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(kBefore + kFrames);
    for (Eigen::Index k = 3; k < x.size(); ++k)
      x[k] = 3.0 * kept * x[k - 1] - 3.0 * kept * kept * x[k - 2] + kept * kept * kept * x[k - 3] +
             random.gaussian();
    x = x.tail(kFrames).eval();
    q.row(c) = testing_body::coordinates(model, 0)[c] +
               0.05 * (x.array() - x.mean()).transpose() / std::sqrt(x.squaredNorm() / kFrames);
  }
  q.row(9) -= 0.7 * (q.row(8).array() - q.row(8).mean()).matrix();
  q.row(12) = 0.6 * q.row(11).array() + 0.05;
  return q;
}

TEST(Smoother, BarsHoldAMovementWithACornerFrequency) {
  const auto model = body();
  constexpr int kDraws = 6;
  double one = 0.0, two = 0.0, count = 0.0;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const auto q = walk_like(model, seed);
    auto markers = testing_body::record(model, kFrames);
    model::Workspace w(model);
    Random random(seed, 6);
    for (std::int64_t f = 0; f < kFrames; ++f) {
      model::kinematics(model, w, model::state_from_coordinates(model, q.col(f)));
      for (std::int64_t m = 0; m < markers.markers(); ++m) {
        const Eigen::Vector3d noise{random.gaussian(), random.gaussian(), random.gaussian()};
        markers.x(f, m) = w.marker.col(m) + 0.004 * noise;
      }
    }
    const auto smooth = smooth_motion(model, markers).value();
    for (std::int64_t f = 0; f < kFrames; ++f)
      for (int c = 0; c < 12; ++c) {
        const auto i = smooth.motion.index(f, c);
        const double z = std::abs(smooth.motion.q[i] - q(c, f)) / smooth.motion.q_sd[i];
        one += z < 1.0, two += z < 1.96, count += 1.0;
      }
  }
  EXPECT_GT(one, 0.62 * count);
  EXPECT_LT(one, 0.76 * count);
  EXPECT_GT(two, 0.92 * count);
  EXPECT_LT(two, 0.98 * count);
}

TEST(Smoother, RatesAreThoseOfTheMotion) {
  const auto model = body();
  const auto smooth = smooth_motion(model, testing_body::record(model, kFrames, 0.0005, 2)).value();
  for (const std::int64_t f : {30, 100, 170})
    for (int c = 0; c < 12; ++c) {
      const double omega = 2.0 * (0.4 + 0.07 * c), phase = omega * static_cast<double>(f) / 100.0 + 0.9 * c;
      const auto i = smooth.motion.index(f, c);
      EXPECT_NEAR(smooth.motion.qd[i], 0.5 * omega * std::cos(phase), 0.08) << c;
      EXPECT_NEAR(smooth.motion.qd[i], 0.5 * omega * std::cos(phase),
                  5.0 * std::sqrt(smooth.errors.covariance[6 * i + 3]));
      EXPECT_NEAR(smooth.motion.qdd[i], -0.5 * omega * omega * std::sin(phase),
                  5.0 * std::sqrt(smooth.errors.covariance[6 * i + 5]));
    }
  EXPECT_NEAR(smooth.motion.qd[smooth.motion.index(50, 12)],
              0.6 * smooth.motion.qd[smooth.motion.index(50, 11)], 1e-9);
}

TEST(Smoother, APrescribedCoordinateIsWhatItsFunctionSays) {
  auto described = testing_body::description();
  const auto elbow = math::ScalarFunction::sine(0.5, 2.0 * (0.4 + 0.07 * 9), 0.9 * 9, 0.15 * 9 - 0.6);
  described.coordinates[9].prescribed = elbow;
  const auto model = model::Model::compile(described).value();
  auto markers = testing_body::record(model, kFrames, kNoise_m);
  for (std::int64_t f = 90; f < 95; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.set_missing(f, m);
  const auto result = smooth_motion(model, markers).value();
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const auto i = result.motion.index(f, 9);
    const auto value = elbow(0.01 * static_cast<double>(f));
    EXPECT_NEAR(result.motion.q[i], value.f, 1e-12) << f;
    EXPECT_EQ(result.motion.q_sd[i], 0.0) << f;
    if (f < 2 || f >= kFrames - 2) continue;
    EXPECT_NEAR(result.motion.qd[i], value.df, 1e-5) << f;
    EXPECT_NEAR(result.motion.qdd[i], value.ddf, 1e-3) << f;
  }
  EXPECT_LT(angle_rms(model, result.motion), 0.01);
}

TEST(Smoother, BridgesMarkersThatAreMissing) {
  const auto model = body();
  auto markers = testing_body::record(model, kFrames, kNoise_m, 3);
  for (std::int64_t f = 80; f < 110; ++f)  // the whole forearm for 0.3 s
    for (const char* name : {"F1", "F2"}) markers.set_missing(f, markers.find(name));
  const auto smooth = smooth_motion(model, markers).value();
  const int elbow = static_cast<int>(smooth.motion.find("elbow"));
  const auto sd = [&](std::int64_t f) { return smooth.motion.q_sd[smooth.motion.index(f, elbow)]; };
  EXPECT_GT(sd(95), 1.5 * sd(40));
  EXPECT_GT(sd(95), sd(82));
  for (std::int64_t f = 80; f < 110; ++f) {
    const double error = smooth.motion.q[smooth.motion.index(f, elbow)] - truth(model, f, elbow);
    EXPECT_LT(std::abs(error), 4.0 * sd(f));
    EXPECT_LT(std::abs(error), 0.3);
  }
}

TEST(Smoother, AFrameWithoutMarkersIsBridgedToo) {
  const auto model = body();
  auto markers = testing_body::record(model, kFrames, kNoise_m, 4);
  for (std::int64_t f = 100; f < 105; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.set_missing(f, m);
  const auto smooth = smooth_motion(model, markers).value();
  EXPECT_LT(angle_rms(model, smooth.motion, 100, 105), 0.05);
  EXPECT_EQ(smooth.motion.status[102], data::FrameStatus::converged);
  EXPECT_TRUE(std::isnan(smooth.motion.marker_error[static_cast<std::size_t>(102 * 14 * 3)]));
}

TEST(Smoother, WhatNoMarkerEverTellsIsUndetermined) {
  const auto model = body();
  auto markers = testing_body::record(model, kFrames, kNoise_m, 5);
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (const char* name : {"F1", "F2"}) markers.set_missing(f, markers.find(name));
  const auto smooth = smooth_motion(model, markers).value();
  const auto elbow = smooth.motion.find("elbow");
  for (const std::int64_t f : {0, 100, 199}) {
    EXPECT_EQ(smooth.motion.determined[smooth.motion.index(f, elbow)], 0);
    EXPECT_TRUE(std::isnan(smooth.motion.q_sd[smooth.motion.index(f, elbow)]));
    EXPECT_EQ(smooth.motion.status[static_cast<std::size_t>(f)], data::FrameStatus::underdetermined);
  }
}

TEST(Smoother, StaysWithinLimits) {
  auto description = testing_body::description();
  description.coordinates[9].range_min = -0.2;  // the elbow swings beyond both
  description.coordinates[9].range_max = 0.9;
  const auto model = model::Model::compile(description).value();
  const auto markers = testing_body::record(body(), kFrames, kNoise_m, 6);
  const auto smooth = smooth_motion(model, markers).value();
  bool touched = false, free = false;
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const double elbow = smooth.motion.q[smooth.motion.index(f, 9)];
    EXPECT_GE(elbow, -0.2 - 1e-9);
    EXPECT_LE(elbow, 0.9 + 1e-9);
    touched = touched || elbow > 0.9 - 1e-9;
    free = free || (elbow < 0.8 && elbow > 0.0);
  }
  EXPECT_TRUE(touched);
  EXPECT_TRUE(free);
  // A path that is cut off at its limits frame by frame is ragged there, and no step over it gains.
  EXPECT_TRUE(smooth.converged);
  EXPECT_LE(smooth.iterations, 15);
}

TEST(Smoother, AnOutlierIsLeftOutOrCountsForLittle) {
  const auto model = body();
  auto markers = testing_body::record(model, kFrames, kNoise_m, 7);
  SmootherOptions believing{.ik = {.judge_samples = false}};
  const auto clean = smooth_motion(model, markers, believing).value();
  const auto elbow = clean.motion.index(100, 9);
  markers.x(100, markers.find("F2")).x() += 0.1;
  const auto change = [&](const SmootherOptions& options) {
    return std::abs(smooth_motion(model, markers, options).value().motion.q[elbow] - clean.motion.q[elbow]);
  };
  auto square = believing;
  square.huber_sd = 0.0;
  EXPECT_LT(change(believing), 0.5 * change(square)) << "where every sample is believed, the loss helps";
  EXPECT_EQ(change({}), change({.huber_sd = 0.0})) << "left out: no loss sees it";
  EXPECT_LT(change({}), clean.motion.q_sd[elbow]);
}

TEST(Smoother, OnlyFramesThatStillMoveAreNotConverged) {
  const auto model = body();
  auto markers = testing_body::record(model, kFrames, kNoise_m, 11);
  for (std::int64_t f = 90; f < 96; ++f)  // a stretch that a few steps do not settle
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.x(f, m).x() += m % 2 == 0 ? 0.3 : -0.3;
  SmootherOptions options{.ik = {.judge_samples = false}};
  std::vector<std::ptrdiff_t> off;
  for (const int steps : {1, 2, 3, 4, 5, 6, 8, 10, 12}) {
    options.max_iterations = steps;
    const auto early = smooth_motion(model, markers, options).value();
    off.push_back(std::ranges::count(early.motion.status, data::FrameStatus::not_converged));
    EXPECT_EQ(early.converged, off.back() == 0) << steps;
  }
  EXPECT_THAT(off, ::testing::Contains(::testing::AllOf(::testing::Gt(0), ::testing::Lt(kFrames))));
  options.max_iterations = 50;
  const auto late = smooth_motion(model, markers, options).value();
  EXPECT_TRUE(late.converged);
  EXPECT_EQ(std::ranges::count(late.motion.status, data::FrameStatus::not_converged), 0);
}

TEST(Smoother, LongRecordingsAreDoneInPieces) {
  const auto model = body();
  const auto whole = smooth_motion(model, testing_body::record(model, 1100, kNoise_m, 8)).value();
  EXPECT_TRUE(whole.converged);
  EXPECT_LT(angle_rms(model, whole.motion, 0, 1100), 0.01);
  // Joints between pieces (every 256 frames) show in nothing.
  const int c = 9;
  for (const std::int64_t f : {255, 256, 511, 512})
    EXPECT_NEAR(whole.motion.q_sd[whole.motion.index(f, c)], whole.motion.q_sd[whole.motion.index(f + 3, c)],
                0.1 * whole.motion.q_sd[whole.motion.index(f, c)]);
}

TEST(Smoother, SoftTissueWidensTheBars) {
  const auto model = body();
  auto markers = testing_body::record(model, 400, 0.001, 9);
  const auto before = smooth_motion(model, markers).value();
  for (std::int64_t f = 0; f < 400; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const double t = static_cast<double>(f) / 100.0, phase = 1.7 * static_cast<double>(m);
      markers.x(f, m) += 0.008 * Eigen::Vector3d(std::sin(3.0 * t + phase), std::cos(2.3 * t + 2.0 * phase),
                                                 std::sin(2.6 * t - phase));
    }
  const auto after = smooth_motion(model, markers).value();
  const auto i = before.motion.index(200, 9);
  EXPECT_GT(after.motion.q_sd[i], 4.0 * before.motion.q_sd[i]);
  EXPECT_GT(coverage(model, after.motion).one, 0.5);
}

TEST(Smoother, BadInputIsReportedInASentence) {
  const auto model = body();
  const auto markers = testing_body::record(model, 20);
  SmootherOptions options;
  options.ik.coordinate_tasks.push_back({.coordinate = "elbow"});
  EXPECT_THAT(smooth_motion(model, markers, options).error().message, HasSubstr("'elbow'"));
  options = {};
  options.ik.loss = Loss::huber;
  EXPECT_THAT(smooth_motion(model, markers, options).error().message, HasSubstr("square loss"));
  options = {};
  options.max_iterations = 0;
  EXPECT_THAT(smooth_motion(model, markers, options).error().message, HasSubstr("iteration limit"));
  options = {};
  options.huber_sd = -1.0;
  EXPECT_THAT(smooth_motion(model, markers, options).error().message, HasSubstr("-1 SD"));
  EXPECT_THAT(smooth_motion(model, testing_body::record(model, 7)).error().message, HasSubstr("7 frames"));
  int asked = 0;
  const auto stopped = smooth_motion(model, markers, {}, [&](std::int64_t, std::int64_t) {
    ++asked;
    return false;
  });
  EXPECT_THAT(stopped.error().message, HasSubstr("stopped"));
  EXPECT_GT(asked, 0);
}

}  // namespace
}  // namespace kinemark::motion
