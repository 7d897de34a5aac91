// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/calibration_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kinemark::reconstruction {
namespace {

using data::CalibrationError;
using data::Points;
using ::testing::SizeIs;

Points scattered(int count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> where(-0.4, 0.4);
  Points out(count, 3);
  for (double& x : out.reshaped()) x = where(random);
  return out.rowwise() + Eigen::RowVector3d(0.2, 1.0, -3.0);
}

/// Three errors: the room is displaced, larger, bent.
Eigen::MatrixXd three_errors(const Points& points) {
  Eigen::MatrixXd out(3 * points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Vector3d x = points.row(i);
    out.block<3, 1>(3 * i, 0) = 1e-3 * Eigen::Vector3d(1.0, 0.0, 2.0);
    out.block<3, 1>(3 * i, 1) = 1e-3 * x;
    out.block<3, 1>(3 * i, 2) = 1e-3 * Eigen::Vector3d(0.0, x.x() * x.z(), x.y() * x.y() * x.y());
  }
  return out;
}

Eigen::MatrixXd covariance_of(const CalibrationError& error, const Points& points) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * points.rows(), 3 * points.rows());
  for (const auto& moved : displacements(error, points)) {
    const Eigen::VectorXd all = moved.transpose().reshaped();
    out += all * all.transpose();
  }
  return out;
}

TEST(CalibrationFields, FieldsHaveTheCovarianceOfAllPoints) {
  const Points points = scattered(40), between = scattered(60).bottomRows(20);
  const Eigen::MatrixXd given = three_errors(points), expected = three_errors(between);
  const auto error = fit_calibration_error(points, given);
  EXPECT_THAT(error.fields, SizeIs(3));
  EXPECT_NEAR((covariance_of(error, points) - given * given.transpose()).cwiseAbs().maxCoeff(), 0.0, 1e-12);
  // Between them too.
  EXPECT_NEAR((covariance_of(error, between) - expected * expected.transpose()).cwiseAbs().maxCoeff(), 0.0,
              1e-12);
}

TEST(CalibrationFields, FieldsThatHoldNextToNothingAreLeftOut) {
  const Points points = scattered(40);
  Eigen::MatrixXd given = three_errors(points);
  given.col(2) *= 1e-3;
  EXPECT_THAT(fit_calibration_error(points, given).fields, SizeIs(2));
  EXPECT_FALSE(fit_calibration_error(points.topRows(0), given.topRows(0)).known());
}

TEST(CalibrationFields, PointsInAPlaneHaveFieldsToo) {
  Points circle(60, 3);
  for (int i = 0; i < 60; ++i)
    circle.row(i) << 0.2 * std::cos(0.21 * i), 0.1 * std::cos(0.21 * i), 0.2 * std::sin(0.21 * i);
  const Eigen::MatrixXd given = three_errors(circle);
  const auto error = fit_calibration_error(circle, given);
  EXPECT_NEAR((covariance_of(error, circle) - given * given.transpose()).cwiseAbs().maxCoeff(), 0.0,
              1e-9);  // of 4e-6: a thousandth may be left out
}

}  // namespace
}  // namespace kinemark::reconstruction
