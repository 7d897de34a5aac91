// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion and its model as analysis::measure_body() takes them.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/analysis/body/body_series.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/motion/internal/rated_motion.h"

namespace kinemark::workflow::internal {

/// A motion with everything that its measures need. Refers to the model, which must outlive it.
struct BodyInput {
  analysis::BodyRecord record;     ///< what does not depend on noise
  analysis::Mechanics mechanics;   ///< torques, mass centre, momentum and feet of one version
  std::vector<std::string> notes;  ///< a sentence each
};

/// Feet as measure_motion() has them; they stand where a plate sees them and where
/// analysis::feet_on_ground() says so.
/// @param rated    gets torques, with deviations where it has some itself
/// @param torques  inverse dynamics without forces too
/// Fails as find_torques().
[[nodiscard]] Result<BodyInput> body_input(const model::Model& model, const GivenMotion& given,
                                           RatedMotion& rated, bool torques, int threads);

}  // namespace kinemark::workflow::internal
