// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/calibration_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>

namespace kinemark::data {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

Points scattered(int count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> where(-0.4, 0.4);
  Points out(count, 3);
  for (double& x : out.reshaped()) x = where(random);
  return out.rowwise() + Eigen::RowVector3d(0.2, 1.0, -3.0);
}

/// Some error of three fields about a place of its own.
CalibrationError some_error() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> size(-1e-3, 1e-3);
  CalibrationError out{.middle_in_world = {0.2, 1.0, -3.0}, .scale_m = 0.4, .fields = {}};
  out.fields.resize(3);
  for (auto& field : out.fields)
    for (double& x : field.reshaped()) x = size(random);
  return out;
}

TEST(CalibrationError, TurnsWithTheWorld) {
  const Points points = scattered(40);
  const auto error = some_error();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  const auto before = displacements(error, points);
  const auto after = displacements(turned(error, turn), points * turn.transpose());
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_NEAR((before[k] * turn.transpose() - after[k]).cwiseAbs().maxCoeff(), 0.0, 1e-15);
}

TEST(CalibrationError, SaysHowMuchIsNotKnown) {
  auto markers = Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 5});
  CalibrationError error{.middle_in_world = {0.0, 0.0, 0.0}, .scale_m = 1.0, .fields = {}};
  error.fields.resize(2, CalibrationError::Field::Zero());
  error.fields[0](0, 0) = 3e-4, error.fields[1](0, 2) = 4e-4;  // the same everywhere
  EXPECT_EQ(rms_of(error, markers), 0.0) << "no sample";
  for (std::int64_t f = 0; f < 3; ++f) {
    markers.x(f, 0) = Eigen::Vector3d(0.1, 0.2, 0.3);
    markers.state[markers.index(f, 0)] = SampleState::measured;
  }
  EXPECT_NEAR(rms_of(error, markers), 5e-4, 1e-12);
  EXPECT_EQ(describe(error, markers),
            "the calibration leaves unknown 0.5 mm of positions, in common (RMS over samples)");
  EXPECT_THAT(describe({}, markers), Not(HasSubstr("of positions, in common (RMS over samples)")));
}

TEST(CalibrationError, WhatHoldsItIsSaidWhereThereIsAny) {
  EXPECT_EQ(note_held("Intervals", 4e-4),
            "Intervals hold what the calibration leaves unknown of all positions: 0.4 mm (RMS)");
  EXPECT_THAT(note_held("Intervals", 0.0),
              Not(HasSubstr("hold what the calibration leaves unknown of all positions: ")));
}

TEST(CalibrationError, ComesBackFromItsText) {
  const Points points = scattered(40);
  const auto error =
      turned(some_error(), Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix());
  const auto back = calibration_error_of(to_text(error));
  ASSERT_TRUE(back);
  const auto before = displacements(error, points), after = displacements(*back, points);
  ASSERT_THAT(after, SizeIs(before.size()));
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_NEAR((before[k] - after[k]).cwiseAbs().maxCoeff(), 0.0, 1e-10);
  EXPECT_EQ(to_text(CalibrationError{}), "");
}

TEST(CalibrationError, TextsThatHoldNoneAreRefused) {
  const Points points = scattered(40);
  const std::string text = to_text(some_error());
  EXPECT_TRUE(calibration_error_of(text));
  EXPECT_TRUE(calibration_error_of(" " + text + " "));
  EXPECT_FALSE(calibration_error_of(""));
  EXPECT_FALSE(calibration_error_of("1 2 3"));
  EXPECT_FALSE(calibration_error_of(text + " 1"));
  EXPECT_FALSE(calibration_error_of(text.substr(0, text.rfind(' ')) + " nan"));
  EXPECT_FALSE(calibration_error_of(text.substr(0, text.rfind(' ')) + " mm"));
  EXPECT_FALSE(calibration_error_of("0 0 0 1 0 0 0 1 0 0 0 -1 1" + text.substr(text.size() / 2)));
  std::string mirrored = "0 0 0 1 0 0 0 1 0 0 0 -1 1", endless = "0 0 0 1 0 0 0 1 0 0 0 1 1",
              flat = "0 0 0 1 0 0 0 1 0 0 0 1 0";
  for (int i = 0; i < 60; ++i) mirrored += " 1", flat += " 1";
  for (int i = 0; i < 13 * 60; ++i) endless += " 1";
  EXPECT_FALSE(calibration_error_of(mirrored));
  EXPECT_FALSE(calibration_error_of(endless));
  EXPECT_FALSE(calibration_error_of(flat));
}

}  // namespace
}  // namespace kinemark::data
