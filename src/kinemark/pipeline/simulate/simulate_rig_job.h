// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/simulation/rig_markers.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::pipeline {

/// What moves before the rig.
enum class RigSceneKind : std::uint8_t { tree, wheel, sign, markers };
[[nodiscard]] Result<RigSceneKind> parse_rig_scene(std::string_view name);  ///< "tree", "wheel", ...

/// What `kinemark simulate rig` is asked to do.
struct SimulateRigJob : JobSettings {
  std::filesystem::path folder;                   ///< made when absent
  RigSceneKind scene = RigSceneKind::sign;        ///< what moves
  int tree_pose = 0;                              ///< 0 to 9
  simulation::WheelOptions wheel;                 ///< for RigSceneKind::wheel
  std::filesystem::path markers;                  ///< for RigSceneKind::markers
  simulation::MarkerSceneOptions marker_options;  ///< for RigSceneKind::markers
  simulation::RigDrawOptions rig;                 ///< how it was drawn
  simulation::RigRecordingOptions recording;      ///< frames, stream and intensity are set here
  bool highest_rate = false;                      ///< the highest frame rate that the time slots allow
  double duration_s = 0.0;  ///< 0: tree 1 s, wheel 2.2 s, sign 4 s, markers as long as they are
  /// Intensity of an LED by name; an empty name means all of them.
  std::vector<std::pair<std::string, double>> intensity;
  /// More occlusions: "LED:CAMERA:FIRST-LAST", frames from 0; LED or camera may be "all".
  std::vector<std::string> occlusions;
  bool grid = false, tree_poses = false, scan = false;  ///< also record these for calibration
};

/// Warnings: rate and time in use; LEDs beside the sheet or too bright.
struct SimulateRigOutcome : JobOutcome {};

/// Write recording.mcap (counts), truth.trc (LEDs at the time of each frame, world of the rig),
/// truth_derivatives.sto (m/s, m/s^2), rig_true.toml, rig_nominal.toml and, where asked for, grid_A.mcap,
/// grid_B.mcap, tree_poses.mcap and scan.mcap. The true rig's offsets hold the room's light of LEDs of
/// intensity 1, as a calibration finds them. Either all files appear or none, nor the folder. The seed draws
/// the rig and its noise. Progress counts files.
[[nodiscard]] Result<SimulateRigOutcome> run_simulate_rig(SimulateRigJob job);

}  // namespace kinemark::pipeline
