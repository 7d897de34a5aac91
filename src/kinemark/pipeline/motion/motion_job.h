// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Inputs and outcome common to the commands that estimate a motion of the model from markers: `ik` and
// `track`.
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/motion/image_files.h"
#include "kinemark/stages/report/ik_summary.h"
#include "kinemark/workflow/motion/gates.h"

namespace kinemark::pipeline {

/// What `kinemark ik` and `track` are asked alike. Axes say how recording and forces are turned into those of
/// the model; times of the selection take precedence over those of a setup.
struct MotionJob : JobSettings, RecordingOptions, workflow::MarkerBounds {
  std::filesystem::path model, markers;  ///< .osim; and any marker file
  std::filesystem::path output;          ///< Q.mot; all other results go beside it
  std::filesystem::path forces;  ///< external forces on the body, for torques: .c3d, or ExternalLoads .xml
  std::vector<std::filesystem::path> geometry;  ///< further folders of the model's meshes, for the page
  ImageFiles images;                            ///< seen besides the markers; none: nothing
  bool into_nwb =
      false;  ///< also Q_angles.nwb: a copy of the recording's file, if it is an NWB, with the angles
};

/// What `kinemark ik` and `track` answer alike.
struct MotionOutcome : JobOutcome {
  report::IkSummary summary;  ///< findings included
};

}  // namespace kinemark::pipeline
