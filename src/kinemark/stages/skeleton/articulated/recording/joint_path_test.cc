// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::skeleton::articulated {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRate_hz = 60.0;

Matrix3d any_information(Random& random, int rank, double scale) {
  Matrix3d I = Matrix3d::Zero();
  for (int i = 0; i < rank; ++i) {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
    I += scale * Vector3d{x, y, z} * Vector3d{x, y, z}.transpose();
  }
  return I;
}

/// A path drawn from the prior, and what frames of mixed rank say of it.
struct Drawn {
  std::vector<PathPoint> points;
  std::vector<Vector3d> truth;
};

Drawn draw(std::uint64_t seed, int frames, double jerk, double sd_m, double lost = 0.0) {
  Random random(seed, 7);
  const double t = 1.0 / kRate_hz;
  Matrix3d Q;
  Q << std::pow(t, 5) / 20, std::pow(t, 4) / 8, std::pow(t, 3) / 6, std::pow(t, 4) / 8, std::pow(t, 3) / 3,
      t * t / 2, std::pow(t, 3) / 6, t * t / 2, t;
  const Matrix3d root = Eigen::LLT<Matrix3d>(jerk * Q).matrixL();
  Matrix3d state = Matrix3d::Zero();  // rows: axes; columns: position, velocity, acceleration
  Drawn out;
  for (int f = 0; f < frames; ++f) {
    const Vector3d x = state.col(0);
    Vector3d error;
    for (int i = 0; i < 3; ++i) error[i] = sd_m * random.gaussian();
    PathPoint p{.position = x + error};
    if (random.uniform() >= lost) p.information = Matrix3d::Identity() / (sd_m * sd_m);
    out.points.push_back(p);
    out.truth.push_back(x);
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d push;
      for (int i = 0; i < 3; ++i) push[i] = random.gaussian();
      push = (root * push).eval();
      const Vector3d s = state.row(axis);
      state(axis, 0) = s[0] + t * s[1] + 0.5 * t * t * s[2] + push[0];
      state(axis, 1) = s[1] + t * s[2] + push[1];
      state(axis, 2) = s[2] + push[2];
    }
  }
  return out;
}

/// The same estimate from one big normal matrix over all states.
struct Dense {
  VectorXd x;
  MatrixXd C;
};

Dense solve_dense(const std::vector<PathPoint>& points, double jerk) {
  const double t = 1.0 / kRate_hz;
  const auto F = static_cast<Eigen::Index>(points.size());
  Matrix3d A1, Q1;
  A1 << 1, t, t * t / 2, 0, 1, t, 0, 0, 1;
  Q1 << std::pow(t, 5) / 20, std::pow(t, 4) / 8, std::pow(t, 3) / 6, std::pow(t, 4) / 8, std::pow(t, 3) / 3,
      t * t / 2, std::pow(t, 3) / 6, t * t / 2, t;
  const Matrix3d W = (jerk * Q1).inverse();
  MatrixXd H = MatrixXd::Zero(9 * F, 9 * F);
  VectorXd b = VectorXd::Zero(9 * F);
  for (Eigen::Index f = 0; f < F; ++f) {
    const PathPoint& p = points[static_cast<std::size_t>(f)];
    H.block<3, 3>(9 * f, 9 * f) += p.information;
    b.segment<3>(9 * f) += p.information * p.position;
    if (f + 1 == F) break;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const Matrix3d AWA = A1.transpose() * W * A1, AW = A1.transpose() * W;
        for (int axis = 0; axis < 3; ++axis) {
          H(9 * f + 3 * i + axis, 9 * f + 3 * j + axis) += AWA(i, j);
          H(9 * f + 3 * i + axis, 9 * (f + 1) + 3 * j + axis) -= AW(i, j);
          H(9 * (f + 1) + 3 * j + axis, 9 * f + 3 * i + axis) -= AW(i, j);
          H(9 * (f + 1) + 3 * i + axis, 9 * (f + 1) + 3 * j + axis) += W(i, j);
        }
      }
  }
  // The smoother's own prior about the first frame: 1 m, 10 m/s, 1000 m/s^2.
  for (int axis = 0; axis < 3; ++axis) {
    H(axis, axis) += 1.0;
    H(3 + axis, 3 + axis) += 1e-2;
    H(6 + axis, 6 + axis) += 1e-6;
  }
  b.head<3>() += points[3].position;
  const MatrixXd C = H.inverse();
  return {.x = C * b, .C = C};
}

TEST(PathSmoother, EqualsTheDenseSolution) {
  Random random(5, 0);
  auto drawn = draw(3, 40, 1e4, 0.002);
  for (std::size_t f = 0; f < drawn.points.size(); ++f)
    drawn.points[f].information = any_information(random, static_cast<int>(f % 4), 1e5);
  const auto path = smooth_path(drawn.points, kRate_hz, 1e4);
  const Dense dense = solve_dense(drawn.points, 1e4);
  for (Eigen::Index f = 0; f < 40; ++f) {
    const auto k = static_cast<std::size_t>(f);
    const Matrix3d C = dense.C.block<3, 3>(9 * f, 9 * f);
    const double sd = std::sqrt(C.trace());
    EXPECT_LT((path.position[k] - dense.x.segment<3>(9 * f)).norm(), 1e-5 * sd) << f;
    EXPECT_LT((path.covariance_at(k) - C).norm(), 1e-5 * C.norm()) << f;
  }
}

TEST(PathSmoother, BlocksLeaveNoSeam) {
  const auto drawn = draw(9, 1300, 1e3, 0.002, 0.3);
  const auto whole = smooth_path(drawn.points, kRate_hz, 1e3);
  // Frames 400 to 700 lie around the first border; seen from a shorter recording they must come out the same.
  const std::span<const PathPoint> part(drawn.points.data() + 200, 900);
  const auto shorter = smooth_path(part, kRate_hz, 1e3);
  for (std::size_t f = 400; f < 900; ++f) {
    ASSERT_LT((whole.position[f] - shorter.position[f - 200]).norm(), 1e-9) << f;
    ASSERT_LT((whole.covariance_at(f) - shorter.covariance_at(f - 200)).norm(), 1e-12) << f;
  }
}

TEST(PathSmoother, ErrorsAreAsLargeAsItSays) {
  double z2 = 0.0, n = 0.0, before = 0.0, after = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto drawn = draw(seed, 400, 1e3, 0.004, 0.4);
    const auto path = smooth_path(drawn.points, kRate_hz, 1e3);
    for (std::size_t f = 0; f < 400; ++f) {
      const Vector3d e = path.position[f] - drawn.truth[f];
      z2 += e.dot(path.covariance_at(f).inverse() * e) / 3.0;
      n += 1.0;
      after += e.squaredNorm();
      before += (drawn.points[f].position - drawn.truth[f]).squaredNorm();
    }
  }
  EXPECT_NEAR(z2 / n, 1.0, 0.15);
  EXPECT_LT(after, 0.5 * before);
}

TEST(PathSmoother, LongGapsStayOpen) {
  auto drawn = draw(2, 600, 1e2, 0.002);
  for (std::size_t f = 200; f < 300; ++f) drawn.points[f].information.setZero();
  for (std::size_t f = 400; f < 440; ++f) drawn.points[f].information.setZero();
  const auto path = smooth_path(drawn.points, kRate_hz, 1e2);
  EXPECT_TRUE(path.known(229)) << "half a second after the last frame";
  EXPECT_FALSE(path.known(230));
  EXPECT_FALSE(path.known(269));
  EXPECT_TRUE(path.known(270));
  EXPECT_TRUE(path.known(420)) << "a short gap is crossed";
  EXPECT_GT(path.covariance_at(420).trace(), 4.0 * path.covariance_at(380).trace());
  EXPECT_TRUE(smooth_path(std::vector<PathPoint>(50), kRate_hz, 1.0).position[7].hasNaN()) << "nothing known";
  EXPECT_TRUE(smooth_path({}, kRate_hz, 1.0).position.empty());
}

TEST(PathSmoother, FindsTheJerkThatWasDrawn) {
  for (const double jerk : {1e1, 1e3, 1e5}) {
    const auto drawn = draw(4, 1500, jerk, 0.001, 0.2);
    const auto prior = find_path_prior(drawn.points, kRate_hz);
    EXPECT_NEAR(std::log10(prior.white_jerk), std::log10(jerk), 0.51);
    EXPECT_TRUE(prior.follows);
    EXPECT_GT(calc_path_likelihood(drawn.points, kRate_hz, jerk),
              calc_path_likelihood(drawn.points, kRate_hz, 30.0 * jerk));
  }
}

TEST(PathSmoother, UsesWindowsOfALongRecording) {
  // Slow enough that the speed stays that of a limb after 25 s.
  const auto drawn = draw(4, 1500, 1e-2, 0.001, 0.2);
  EXPECT_NEAR(std::log10(find_path_prior(drawn.points, kRate_hz, 400).white_jerk), -2.0, 0.51);
}

TEST(PathSmoother, SeesThatFramesAreUnrelated) {
  Random random(8, 0);
  std::vector<PathPoint> points(500);
  for (auto& p : points) {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
    p.position = 0.1 * Vector3d{x, y, z};
    p.information = 1e6 * Matrix3d::Identity();
  }
  EXPECT_FALSE(find_path_prior(points, kRate_hz).follows);
}

TEST(PathSmoother, ATrihedralFixesAPositionAndAPlaneDoesNot) {
  PathPoint p;
  EXPECT_FALSE(holds_a_position(p));
  p.information.diagonal() << 1e6, 1e6, 0.0;
  EXPECT_FALSE(holds_a_position(p));
  p.information(2, 2) = 1e3;
  EXPECT_TRUE(holds_a_position(p));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
