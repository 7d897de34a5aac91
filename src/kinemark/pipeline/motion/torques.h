// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "kinemark/workflow/motion/torques.h"
#include "kinemark/workflow/prepare/axes.h"

namespace kinemark::pipeline {

/// Facts about the torques of a motion, and the files that they rest on.
struct TorqueAccount : workflow::TorqueAccount {
  std::vector<std::filesystem::path> files;  ///< of forces, as read
};

/// Fill tau (and tau_sd) of a motion by inverse dynamics, with the forces of a file unless `forces` is empty.
/// Forces in other axes than the model's: workflow::check_forces().
/// @param errors  of the motion's rates; null: estimated
/// @param axes    how the recording was turned; the forces are turned alike
[[nodiscard]] Result<TorqueAccount> add_torques(const model::Model& model, data::JointMotion& motion,
                                                const std::filesystem::path& forces,
                                                const motion::DynamicsOptions& options,
                                                const motion::RateErrors* errors = nullptr,
                                                const workflow::Axes& axes = {});

}  // namespace kinemark::pipeline
