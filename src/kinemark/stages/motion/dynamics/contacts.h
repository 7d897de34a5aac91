// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"

namespace kinemark::motion {

/// Which body each wrench acts on, frame by frame: W x F tree indices, data::kGround where nothing acts.
struct ContactPlan {
  std::vector<std::vector<int>> body;  ///< W x F
  std::vector<Contact> contacts;       ///< by wrench and time
};

/// Tree indices of the bodies that are named as feet, by the caller or by themselves. Fails for a name that
/// the model does not have.
[[nodiscard]] Result<std::vector<int>> find_feet(const model::Model& model,
                                                 const std::vector<std::string>& named);

/// A wrench that names its body acts there. Any other acts, over each stretch of frames with more than
/// contact_force_n, on the one of `feet`, or of all bodies where there are none, whose mass centre is nearest
/// to the point of force on average. Fails for a body or foot that the model does not have. Wrenches must be
/// validated and as long as the motion.
[[nodiscard]] Result<ContactPlan> plan_contacts(const model::Model& model, const data::JointMotion& motion,
                                                const data::Wrenches& wrenches, std::vector<int> feet,
                                                double contact_force_n);

}  // namespace kinemark::motion
