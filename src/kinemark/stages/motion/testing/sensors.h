// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Inertial sensors on the body of the tests, in random places, in a world of their own.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/orientations.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::testing_body {

inline const std::vector<std::string> kSensorBodies{"trunk", "upper_arm", "forearm", "thigh", "shank"};

/// The body of the tests, with an elbow and a knee that move one way.
[[nodiscard]] model::Model one_way_body();

/// Sensors on a moving body: their world is turned by `heading` and has its z upwards.
struct Session {
  model::Model model = one_way_body();
  data::Orientations recording, pose;
  Eigen::MatrixXd truth;  ///< n x F, at the instants of the recording
};

/// The motion of coordinates() at `rate_hz`, and a pose of 20 frames.
[[nodiscard]] Session session(double heading_rad, double noise_rad, std::uint64_t seed,
                              std::int64_t frames = 200,
                              const std::vector<std::string>& bodies = kSensorBodies, double rate_hz = 60.0);

}  // namespace kinemark::motion::testing_body
