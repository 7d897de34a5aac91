// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Torques of a motion, and what there is to say of the forces behind them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/run_record.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"

namespace kinemark::workflow {

/// Facts about the torques of a motion, for a report.
struct TorqueAccount {
  std::vector<std::pair<std::string, std::string>>
      facts;  ///< which plate acted on which body and when; how long forces are unknown; the residual of the
              ///< root
  std::vector<std::string> warnings;  ///< one sentence each
  std::vector<data::Gate> gates;      ///< masses that no body has
};

/// Fill tau (and tau_sd) of a motion by inverse dynamics. Fails as motion::inverse_dynamics().
/// @param forces  on the motion's frames, in the model's axes; null: none are known
/// @param errors  of the motion's rates; null: estimated
[[nodiscard]] Result<TorqueAccount> add_torques(const model::Model& model, data::JointMotion& motion,
                                                const data::Wrenches* forces,
                                                const motion::DynamicsOptions& options,
                                                const motion::RateErrors* errors = nullptr);

}  // namespace kinemark::workflow
