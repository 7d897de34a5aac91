// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/ik_recordings.h"

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/motion/ik_job.h"

namespace kinemark::testing_support {

const std::vector<IkRecording>& ik_recordings() {
  static const std::vector<IkRecording> all = {
      {.name = "nimble",
       .model = "nimble-arnold-synthetic/subject01/subject01.osim",
       .markers = "nimble-arnold-synthetic/subject01/trials/walk2/markers.trc"},
      {.name = "core_ik",
       .model = "opensim-core-ik/subject01_simbody.osim",
       .markers = "opensim-core-ik/subject01_synthetic_marker_data.trc",
       .setup = "opensim-core-ik/subject01_Setup_InverseKinematics.xml"},
      {.name = "gait2354",
       .model = "opensim-gait2354/subject01_simbody.osim",
       .markers = "opensim-gait2354/subject01_walk1.trc",
       .setup = "opensim-gait2354/subject01_Setup_IK.xml"},
      {.name = "gait2354_whole",
       .model = "opensim-gait2354/subject01_simbody.osim",
       .markers = "opensim-gait2354/subject01_walk1.trc"},
      {.name = "shoulder",
       .model = "opensim-core-ik/subject1_abdbonepin.osim",
       .markers = "opensim-core-ik/abdbonepin.trc",
       .setup = "opensim-core-ik/setup_ik_abdbonepin.xml",
       .defects = "the upper arm leaves the shoulder blade by 40 mm for six frames, twice"},
      {.name = "hamner",
       .model = "opensim-hamner-fullbody/subject02_registered.osim",
       .markers = "opensim-hamner-fullbody/subject02_running.trc",
       .setup = "opensim-hamner-fullbody/Setup_IK.xml"},
      {.name = "running",
       .model = "bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim",
       .markers = "bmc-rajagopal-run/ExpData/motion_capture_run.trc",
       .setup = "bmc-rajagopal-run/IK/IK_setup.xml",
       .defects = "RTOE and RMT5 carry each other's label in every third frame"},
      {.name = "arm", .model = "opensim-arm26/arm26.osim", .markers = "opensim-arm26/arm26_elbow_flex.trc"}};
  return all;
}

IkCase open_ik_recording(const std::filesystem::path& data, const IkRecording& recording) {
  IkCase c{.model = model::Model::compile(io::read_osim(data / recording.model).value()).value(),
           .markers = io::read_markers(data / recording.markers).value().markers};
  if (recording.setup.empty()) return c;
  pipeline::IkJob job;
  job.setup = data / recording.setup;
  job.model = data / recording.model;
  job.markers = data / recording.markers;
  pipeline::apply_setup(job).value();
  pipeline::apply_tasks(job, c.model, c.markers).value();
  c.options = job.options;
  return c;
}

}  // namespace kinemark::testing_support
