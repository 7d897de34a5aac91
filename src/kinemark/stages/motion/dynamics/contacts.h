// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  std::vector<int> feet;               ///< tree indices of the bodies that options or their names call feet
};

/// A wrench that names its body acts there. Any other acts, over each stretch of frames with more than
/// contact_force_n, on the one foot whose mass centre is nearest to the point of force on average. Fails for
/// a body or foot that the model does not have. Wrenches must be validated and as long as the motion.
[[nodiscard]] Result<ContactPlan> plan_contacts(const model::Model& model, const data::JointMotion& motion,
                                                const data::Wrenches& wrenches,
                                                const DynamicsOptions& options);

}  // namespace kinemark::motion
