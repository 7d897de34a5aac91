// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion with the rates of its coordinates, and its torques.
#pragma once

#include <cstdint>
#include <optional>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "kinemark/stages/motion/smoother/rates.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/motion/torques.h"

namespace kinemark::workflow::internal {

/// F frames, n coordinates.
struct RatedMotion {
  data::JointMotion motion;       ///< q, qd, qdd; q_sd where deviations are known
  Array<std::uint8_t> is_filled;  ///< F x n; 1: nobody measured it
  motion::RateErrors errors;      ///< of q, qd and qdd
};

/// Couplings are applied, rates found. What was filled, or has no deviation where others have one, is not
/// `determined`. A motion that is filtered here has no q_sd.
///
/// Frames that were made between those that were measured, as a motion of an upsampled recording has them,
/// are refused unless it is filtered: rates would be those of what made them.
///
/// Code::bad_input for a motion of another model and as motion::estimate_rates(); Code::usage for a cut-off
/// that is none or beyond half the rate.
[[nodiscard]] Result<RatedMotion> rate_motion(const model::Model& model, const GivenMotion& given,
                                              double cutoff_hz);

/// Torques that were filled in, and what they rest on.
struct TorquesFound {
  TorqueAccount account;                 ///< what there is to say of them
  std::optional<data::Wrenches> forces;  ///< on the motion's frames; none: none were given
};

/// Fill tau and, with error bars, tau_sd of the motion. An error begins with the name of the forces where
/// there are some. Fails as check_forces() and motion::inverse_dynamics().
[[nodiscard]] Result<TorquesFound> find_torques(const model::Model& model, const GivenMotion& given,
                                                RatedMotion& rated, const motion::DynamicsOptions& options);

}  // namespace kinemark::workflow::internal
