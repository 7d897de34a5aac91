// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres and axes of a recording of markers: what to do with the recorder's own samples and with
// defects, segments from a file or from the data, one of several methods, files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/functional/slip.h"
#include "kinemark/stages/skeleton/topology/topology.h"

namespace kinemark::pipeline {

/// What `kinemark joints` is asked to do. Paths that are empty are not used.
struct JointsJob {
  std::filesystem::path input;     ///< .c3d, .trc, .csv, .nwb or .v3d
  double rate_hz = 0.0;            ///< for a marker file that stores none (.v3d); 0: not given
  std::filesystem::path segments;  ///< TOML, see read_segments(); empty: found in the data
  /// A folder (no ending, or there already): centres.csv, centres.c3d, segments.toml and skeleton.json. A
  /// file: the centres in its format, and NAME_skeleton.json beside it.
  std::filesystem::path output;
  std::string method = "articulated";  ///< that, or a name of parse_functional_method()
  /// for functional methods: in which segments the centre is held still
  skeleton::Sides sides = skeleton::Sides::both;
  data::JointChoice kind = data::JointChoice::automatic;  ///< of all joints
  double noise_sd_m = 0.0;                                ///< per axis; 0: found
  bool continuity = true;                                 ///< articulated: smooth in time and bridge
  bool soft_tissue = false;     ///< articulated alone: every marker has a noise of its own
  bool keep_upsampled = false;  ///< use the samples that the recorder made as well
  bool keep_defects = false;    ///< use what screening calls swapped, stuck, false
  int threads = 1;              ///< 0: all cores. Any number gives the same bits.
  std::uint64_t seed = 1;       ///< of random draws
  bool force = false;           ///< replace files that exist
  std::string command_line;     ///< for the provenance record
};

/// What `kinemark joints` found.
struct JointsOutcome {
  data::Skeleton skeleton;                     ///< segments, joints, centres
  std::optional<skeleton::Topology> topology;  ///< when the segments were found in the data
  std::vector<skeleton::Slip> slips;           ///< markers that moved on their segment
  std::vector<double> marker_noise_sd_m;       ///< M, with soft_tissue; NaN where unknown; empty otherwise
  std::vector<std::string> notes;              ///< processing steps and irregularities, one sentence each
  nlohmann::ordered_json json;                 ///< as skeleton.json
  std::vector<std::filesystem::path> written;  ///< all files, in order
  int exit_status = 0;                         ///< 0, or 1 when a joint was placed in no frame
};

/// Read, find, write. Either all files appear or, on a failure, none.
[[nodiscard]] Result<JointsOutcome> run_joints(const JointsJob& job, const Progress& progress = {});

/// The centres as trajectories, one a joint. States: model_filled where the joint was placed by its frame,
/// interpolated where with the help of others; the method's name ends in ": determined", ": bridged" or
/// ": ambiguous".
[[nodiscard]] data::Trajectories centre_trajectories(const data::Skeleton& skeleton);

/// A skeleton without its frames as JSON (SI units, degrees where a name says so); unknown numbers are null.
[[nodiscard]] nlohmann::ordered_json skeleton_json(const data::Skeleton& skeleton);

/// One line a joint for people: name, method, frames, words.
[[nodiscard]] std::vector<std::string> skeleton_words(const data::Skeleton& skeleton);

}  // namespace kinemark::pipeline
