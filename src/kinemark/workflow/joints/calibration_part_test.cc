// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/internal/calibration_part.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/data/calibration_error.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/workflow/joints/joints.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kShift_m = 3e-4, kScale = 2e-3;

/// The room is displaced along y and, by a field of its own, larger by a share that is not known.
data::CalibrationError shifted_and_scaled() {
  data::CalibrationError error{.middle_in_world = Eigen::Vector3d::Zero(), .scale_m = 1.0, .fields = {}};
  error.fields.resize(2, data::CalibrationError::Field::Zero());
  error.fields[0](0, 1) = kShift_m;
  const data::Points axes = Eigen::Matrix3d::Identity();
  const auto terms = data::terms_of(error, axes);
  for (int axis = 0; axis < 3; ++axis)
    for (int term = 1; term < data::CalibrationError::kTerms; ++term)
      if (terms(axis, term) == 1.0) {  // the first that only this axis has is the linear one
        error.fields[1](term, axis) = kScale;
        break;
      }
  return error;
}

data::Recording arm(const simulation::LimbRecording& limb) { return {.trial = {.markers = limb.markers}}; }

TEST(CalibrationOfJoints, DisplacesCentresAndStretchesLengths) {
  const auto limb =
      simulation::simulate_sleeve({.duration_s = 3.0, .noise_sd_m = 0.0005, .line_of_sight = false}).value();
  const auto plain = joints(arm(limb), {.segments = limb.layout}).value().skeleton;
  auto wider = plain;
  const auto error = shifted_and_scaled();
  const double rms_m = internal::add_calibration_error(error, wider);
  EXPECT_GT(rms_m, kShift_m);
  for (std::int64_t f = 0; f < plain.frames(); f += 50) {
    const Eigen::Vector3d c = plain.centre(f, 0), up = kShift_m * Eigen::Vector3d::UnitY();
    const Eigen::Matrix3d more = wider.centre_covariance(f, 0) - plain.centre_covariance(f, 0);
    const Eigen::Matrix3d expected = up * up.transpose() + kScale * kScale * c * c.transpose();
    EXPECT_LT((more - expected).norm(), 1e-12);
  }
  ASSERT_EQ(plain.ends.size(), 1U);
  const auto &before = plain.ends[0], &after = wider.ends[0];
  EXPECT_NEAR(std::sqrt(std::pow(after.length_sd_m, 2) - std::pow(before.length_sd_m, 2)),
              kScale * before.length_m, 0.02 * kScale * before.length_m);
  EXPECT_GT(after.covariance_in_world[3], before.covariance_in_world[3] + 0.99 * kShift_m * kShift_m);
}

TEST(CalibrationOfJoints, IsSaidWhereItIsKnownAndNotElsewhere) {
  const auto limb =
      simulation::simulate_sleeve({.duration_s = 3.0, .noise_sd_m = 0.0005, .line_of_sight = false}).value();
  auto recording = arm(limb);
  EXPECT_THAT(joints(recording, {.segments = limb.layout}).value().remarks.warnings,
              Not(Contains(HasSubstr("Deviations of centres and lengths hold"))));
  recording.trial.calibration_error = shifted_and_scaled();
  recording.trial.calibration_error.fields.resize(1);
  EXPECT_THAT(joints(recording, {.segments = limb.layout}).value().remarks.warnings,
              Contains("Deviations of centres and lengths hold what the calibration leaves unknown of all "
                       "positions: 0.3 mm (RMS)"));
}

}  // namespace
}  // namespace kinemark::workflow
