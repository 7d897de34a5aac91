// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion and its model as analysis::measure_body() takes them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/motion/rated_motion.h"
#include "kinemark/pipeline/motion/torques.h"
#include "kinemark/stages/analysis/body/body_series.h"

namespace kinemark::pipeline {

/// A motion with everything that its measures need. Refers to the model, which must outlive it.
struct BodyInput {
  analysis::BodyRecord record;               ///< what does not depend on noise
  analysis::Mechanics mechanics;             ///< torques, mass centre, momentum and feet of one version
  std::vector<std::filesystem::path> files;  ///< of forces, as read
  std::vector<std::string> notes;            ///< a sentence each
};

/// @param forces   file of external forces; empty: none
/// @param torques  inverse dynamics without forces too
///
/// Feet are the bodies whose names hold "calcn", "foot" or "toes", their sides those of the names, their
/// outline the model's markers on them. They stand where a plate sees them and where
/// analysis::feet_on_ground() says so. Fails as add_torques().
[[nodiscard]] Result<BodyInput> body_input(const model::Model& model, const RatedMotion& read,
                                           const std::filesystem::path& forces, bool torques, int threads);

}  // namespace kinemark::pipeline
