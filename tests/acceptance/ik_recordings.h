// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The real recordings that come with a model: cases of inverse kinematics.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::testing_support {

struct IkRecording {
  std::string name, model, markers, setup;  ///< files below the data folder; setup: OpenSim's, or empty
  /// What is wrong with the recording itself; empty: nothing that anyone knows of.
  std::string defects = {};
};

[[nodiscard]] const std::vector<IkRecording>& ik_recordings();

struct IkCase {
  model::Model model;
  data::Trajectories markers;
  motion::IkOptions options;  ///< of the setup: weights, coordinate tasks, time range
};

/// Reads files and setup; throws where one cannot be read.
[[nodiscard]] IkCase open_ik_recording(const std::filesystem::path& data, const IkRecording& recording);

}  // namespace kinemark::testing_support
