// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Recordings as they meet the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/workflow/scale/scale.h"

namespace kinemark::workflow {

/// Frames that the recorder made between those that it measured are left out, which is a note: a fit would
/// take them for measurements of their own. Fails as screen_markers(), naming the trial.
Status keep_measured(ScaleTrial& trial);

/// Samples that are surely swapped, stuck or false are left out. Fails as leave_out_defects(), naming the
/// trial.
Status leave_out_doubtful(ScaleTrial& trial);

/// The still recordings against a model, before anything moves, and against the motion where there is one:
/// each as its file has it, as a judge turns them itself. Static trials and remarks of `found` grow.
Status judge_stills(const std::vector<const ScaleTrial*>& stills, const std::optional<ScaleTrial>& motion,
                    const std::string& model_name, ScaleFound& found);

/// A recording is turned into the axes of the model so far; what its samples went through and what was done
/// to it are said, each sentence once.
Status bring_to_model(const AxesChoice& axes, const std::string& model_name, ScaleTrial& trial,
                      ScaleFound& found);

}  // namespace kinemark::workflow
