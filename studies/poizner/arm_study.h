// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "kinemark/core/result.h"
#include "studies/poizner/calibrated_rig.h"
#include "studies/poizner/coverage.h"
#include "studies/poizner/wheel_study.h"

namespace kinemark::studies {

/// One LED of the arm, by both methods.
struct ArmLed {
  std::string name;
  MotionErrors classic, ours, predicted;
  double gap_rms_m = 0.0;  ///< ours, in frames that a camera or both did not see; 0 without any
  double fastest_error_m_s = 0.0,
         slowest_error_m_s = 0.0;  ///< ours: of the largest and smallest speed, signed
  double classic_fastest_error_m_s = 0.0, classic_slowest_error_m_s = 0.0;
  int order = 0;
  double cutoff_hz = 0.0;
};

struct ArmOutcome {
  std::vector<ArmLed> leds;                                        ///< shoulder, elbow, wrist, hand
  std::array<double, 3> classic_length_sd_m{}, our_length_sd_m{};  ///< upper arm, forearm, hand
  Coverage positions, rates;
  std::vector<Eigen::Matrix3Xd> classic_paths;  ///< per LED, true world, m
  std::vector<AlignedPath> our_paths;
  std::vector<Eigen::Matrix3Xd> true_paths, true_velocity, true_acceleration;
};

/// Scenario S3: 400 frames at 100 Hz of LOOK-AT[Continuative] with its three occlusions.
[[nodiscard]] Result<ArmOutcome> study_arm(const CalibratedRig& rig);

}  // namespace kinemark::studies
