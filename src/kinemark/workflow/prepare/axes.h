// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The one place where the axes of a recording and those of a model are brought together.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/model/model.h"

namespace kinemark::workflow {

/// How a recording is to be turned before it meets a model. Both empty: not at all, and a recording whose
/// vertical is known and is another than the model's is refused.
struct AxesChoice {
  std::string up;      ///< the recording's axis that points up, "z"; "auto": the one that is found
  std::string rotate;  ///< a rotation instead, "x -90"

  /// At most one is given, and it is understood: Code::usage.
  [[nodiscard]] Status check() const;
};

/// A settled choice.
struct Axes {
  Eigen::Matrix3d model_from_recording = Eigen::Matrix3d::Identity();  ///< rotation
  bool chosen = false;                                                 ///< by whoever asked
  std::string note;  ///< what was done, "the recording was turned: x -90"; empty: nothing
};

/// The rotation that brings a recording into a model's axes, up being against its gravity.
///
/// Without a choice, a vertical that is found and lies 45 deg or more off the model's is Code::bad_input,
/// with the option to give; "auto" without a vertical that is found likewise. What was chosen is done.
[[nodiscard]] Result<Axes> settle_axes(const AxesChoice& choice, const std::filesystem::path& path,
                                       const data::Trial& trial, const model::Model& model);

/// settle_axes(), and the trial turned; what was done goes to its warnings.
[[nodiscard]] Result<Axes> bring_into_axes(const AxesChoice& choice, const std::filesystem::path& path,
                                           data::Trial& trial, const model::Model& model);

/// Forces, turned as their recording was, push the body up: where their mean lies 45 deg or more off the
/// model's up, Code::bad_input with the ways out; a sentence instead where the axes were chosen. Empty: they
/// do, or are too small to say (10 N in the mean).
[[nodiscard]] Result<std::string> check_forces(const data::Wrenches& wrenches, const Axes& axes,
                                               const model::Model& model);

}  // namespace kinemark::workflow
