// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion of a body as its measures take it: F frames, n coordinates.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/gait_event.h"

namespace kinemark::analysis {

/// What is computed of one smoothed or simulated version of a motion.
struct BodySeries {
  Eigen::MatrixXd q;                 ///< F x n, rad or m
  Eigen::MatrixXd v;                 ///< F x n, dq/dt
  Eigen::MatrixXd a;                 ///< F x n, d2q/dt2
  Eigen::MatrixXd tau;               ///< F x n, N m or N; NaN where not known; empty: no torques
  Eigen::MatrixX3d centre;           ///< F x 3, mass centre, m; no rows: not known
  Eigen::MatrixX3d centre_velocity;  ///< F x 3, m/s
  Eigen::MatrixX3d momentum;         ///< F x 3, angular momentum about the mass centre, kg m^2/s
  /// Points of the left and the right foot that may bear load, each F x 3, m.
  std::array<std::vector<Eigen::MatrixX3d>, 2> outline;
};

/// Fills tau, the body and the outline from q, v and a. Called from several threads.
using Mechanics = std::function<Status(BodySeries&)>;

/// A motion as it was found, and what of it does not depend on its noise.
struct BodyRecord {
  TimeBase time;                      ///< F = time.frames
  std::vector<std::string> names;     ///< n
  std::vector<bool> is_rotation;      ///< n; true: rad, false: m
  std::vector<bool> measured;         ///< n: independent and free to move
  std::vector<bool> driven;           ///< n: whose torque is a joint's, not the residual of a root
  std::vector<bool> is_root;          ///< n: moves the whole body
  Eigen::MatrixXd q;                  ///< F x n, finite
  Eigen::MatrixXd q_sd;               ///< F x n, one standard deviation, NaN where not known; or empty
  Eigen::MatrixX<bool> determined;    ///< F x n
  Eigen::MatrixX<bool> torque_known;  ///< F x n; empty: no torques
  Eigen::MatrixX<bool> contact;       ///< F x 2, plates see the left, the right foot; empty: none tell
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  ///< length 1
  double gravity = 9.80665;                       ///< m/s^2
  double mass_kg = 0.0;                           ///< of the body; 0: not known

  [[nodiscard]] std::int64_t frames() const { return time.frames; }      ///< F
  [[nodiscard]] std::int64_t size() const { return std::ssize(names); }  ///< n
};

/// Frames [first, first + count) of a motion.
struct BodyStretch {
  std::string name;                   ///< empty: the whole motion
  std::string context;                ///< "Left", "Right" of a cycle, or empty
  std::int64_t cycle = -1;            ///< from 0, of the context; -1: it is none
  std::int64_t first = 0, count = 0;  ///< frames
};

/// "Left" or "Right" for a name that ends in _l or _r (or Left, Right), else empty.
[[nodiscard]] std::string side_of_name(const std::string& name);

}  // namespace kinemark::analysis
