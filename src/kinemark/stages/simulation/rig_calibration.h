// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Recordings to calibrate a rig from: a plane grid of LEDs, the moved tree, an LED on a motor stage.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "kinemark/stages/simulation/rig_recording.h"

namespace kinemark::simulation {

/// The grid that hangs before one camera at a time, square to its axis within the accuracy of mounting it by
/// hand.
struct GridOptions {
  int nodes = 15;                               ///< along each side, 3 to 101, odd
  double side_m = 1.0;                          ///< between the outermost LEDs, > 0
  double distance_m = 3.0;                      ///< from the lens
  int samples = 50;                             ///< conversions of every LED, 1 to 10 000
  double placement_sd_m = 0.5e-3;               ///< of each LED on the board, in either direction
  double tilt_sd_deg = 0.2, roll_sd_deg = 0.1;  ///< one standard deviation of how it hangs, >= 0
  /// one standard deviation along the axis and across it, >= 0
  double distance_sd_m = 5e-3, centre_sd_m = 1e-3;
  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// The grid as every camera recorded it, and where its LEDs really were.
struct GridRecording {
  /// Per camera: one camera, nodes x nodes LEDs named "i,j" (i to the camera's right, j down, both from 0),
  /// `samples` frames. LEDs are lit one at a time; each has the time of its own slot.
  std::vector<data::Counts> counts;
  int nodes = 0;                           ///< along each side
  double spacing_m = 0.0;                  ///< between neighbours, as the operator believes
  double distance_m = 0.0;                 ///< from the lens, as the operator believes
  std::vector<Eigen::Matrix3Xd> x_in_cam;  ///< truth: where the LEDs were, m, in the order of the LEDs
};

/// Random(seed, 200): positions of the LEDs on the board, the same board for all cameras. Random(seed, 210 +
/// camera): tilt 2, distance, centre 2, roll, then noise, sample by sample.
[[nodiscard]] Result<GridRecording> record_grid(const PhysicalRig& rig, const GridOptions& options = {});

/// The tree carried through the volume and held still, pose after pose.
struct TreePosesOptions {
  int poses = 300;           ///< 1 to 10 000
  int frames_per_pose = 10;  ///< 1 to 1000
  int set = 0;               ///< another set of poses and noise of the same rig, 0 to 1000
  RigRecordingOptions
      recording;  ///< rate, intensity, noise, threads; frames, time, seed and stream are set here
  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// A tree of LEDs held still in many poses, and where they really were.
struct TreePosesRecording {
  data::Counts counts;                         ///< poses x frames_per_pose frames, three LEDs
  int frames_per_pose = 0;                     ///< of each pose
  std::vector<Eigen::Matrix3d> leds_in_world;  ///< truth of each pose: columns are LEDs, m
};

/// Poses are drawn in a box of 0.7 x 0.9 x 1.0 m, turned by up to 50, 40 and 180 degrees, and kept when both
/// cameras see all LEDs within 0.96 half-sides. Random(seed, 500 + set): poses, eight draws each;
/// Random(seed, 10000 + 1000 set + pose): noise.
[[nodiscard]] Result<TreePosesRecording> record_tree_poses(const PhysicalRig& rig,
                                                           const TreePosesOptions& options = {});

/// One LED on a motor stage that visits a lattice of positions.
struct ScanOptions {
  Eigen::Vector3i positions{8, 9, 6};                    ///< along X, Y, Z, 2 to 50 each
  Eigen::Vector3d size_m{0.8, 0.8, 0.8};                 ///< of the lattice, about the world's origin
  int frames_per_position = 10;                          ///< 1 to 1000
  double stage_sd_m = 25e-6;                             ///< error of the stage, per axis
  double alignment_sd_deg = 0.2, alignment_sd_m = 5e-3;  ///< of the stage as a whole
  RigRecordingOptions
      recording;  ///< rate, intensity, noise, threads; frames, time, seed and stream are set here
  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// One LED carried through the volume by a stage, and where it really was.
struct ScanRecording {
  data::Counts counts;          ///< positions x frames_per_position frames, one LED
  int frames_per_position = 0;  ///< at each position
  Eigen::Matrix3Xd x_in_stage;  ///< position reported by the stage, m
  Eigen::Matrix3Xd x_in_world;  ///< truth, m
  math::SE3 world_from_stage;   ///< truth
};

/// Random(seed, 600): pose of the stage, then its errors; Random(seed, 601): noise.
[[nodiscard]] Result<ScanRecording> record_scan(const PhysicalRig& rig, const ScanOptions& options = {});

}  // namespace kinemark::simulation
