// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "kinemark/data/calibration_error.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using namespace testing_body;

constexpr std::int64_t kSeen = 40;
constexpr double kMarkerNoise_m = 0.5e-3;

/// One field that lengthens x, shears y along z and curves z, small enough for first order.
data::CalibrationError curved(double size_m) {
  data::CalibrationError error{.middle_in_world = {0.1, 0.9, 0.0}, .scale_m = 1.0, .fields = {}};
  data::CalibrationError::Field field = data::CalibrationError::Field::Zero();
  field(1, 1) = 0.7 * size_m;   // z: y is sheared
  field(10, 0) = 1.0 * size_m;  // x: longer
  field(7, 2) = -2.0 * size_m;  // y^2: z is curved
  error.fields = {field};
  return error;
}

/// The recording as a rig sees it whose calibration is wrong by one standard deviation of the field.
data::Trajectories displaced(const data::CalibrationError& error, data::Trajectories markers) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      if (!markers.present(f, m)) continue;
      const data::Points at = markers.x(f, m).transpose();
      markers.x(f, m) += data::displacements(error, at).front().row(0).transpose();
    }
  return markers;
}

TEST(CalibrationOfMotion, WidensByWhatTheFieldMovesTheCoordinates) {
  const auto model = model::Model::compile(description()).value();
  auto markers = record(model, kSeen, kMarkerNoise_m, 8);
  for (std::int64_t f = 10; f < 20; ++f) markers.set_missing(f, 3);
  const auto error = curved(1e-4);
  IkOptions options;
  options.marker_weights = {{.marker = markers.names[1], .weight = 3.0}};
  options.judge_samples = false;
  const auto as_it_is = solve_ik(model, markers, options).value();
  const auto wrong = solve_ik(model, displaced(error, markers), options).value();
  auto motion = as_it_is.motion;
  ASSERT_TRUE(add_calibration_error(model, markers, error, options, motion).has_value());
  int compared = 0;
  for (std::size_t i = 0; i < motion.q.size(); ++i) {
    if (motion.determined[i] == 0) continue;
    const double before = as_it_is.motion.q_sd[i], after = motion.q_sd[i];
    const double more = std::sqrt(std::max(0.0, after * after - before * before));
    const double moved = std::abs(wrong.motion.q[i] - as_it_is.motion.q[i]);
    EXPECT_NEAR(more, moved, 0.02 * moved + 2e-6);
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

TEST(CalibrationOfMotion, LeavesDeviationsAsTheyAreWhereNothingIsKnownOfIt) {
  const auto model = model::Model::compile(description()).value();
  const auto markers = record(model, kSeen, kMarkerNoise_m, 8);
  const auto found = solve_ik(model, markers).value();
  auto motion = found.motion;
  ASSERT_TRUE(add_calibration_error(model, markers, {}, {}, motion).has_value());
  for (std::size_t i = 0; i < motion.q_sd.size(); ++i)
    if (motion.determined[i] != 0) EXPECT_EQ(motion.q_sd[i], found.motion.q_sd[i]);
}

TEST(CalibrationOfMotion, WhatBecomesWiderThanAnErrorBarMaySayIsOpen) {
  const auto model = model::Model::compile(description()).value();
  const auto markers = record(model, kSeen, kMarkerNoise_m, 8);
  auto motion = solve_ik(model, markers).value().motion;
  const auto determined = motion.determined;
  ASSERT_TRUE(add_calibration_error(model, markers, curved(0.5), {}, motion).has_value());
  int lost = 0;
  for (std::size_t i = 0; i < motion.q_sd.size(); ++i) {
    if (determined[i] == 0) continue;
    EXPECT_EQ(motion.determined[i] == 0, std::isnan(motion.q_sd[i]));
    lost += motion.determined[i] == 0;
  }
  EXPECT_GT(lost, kSeen);
}

}  // namespace
}  // namespace kinemark::motion
