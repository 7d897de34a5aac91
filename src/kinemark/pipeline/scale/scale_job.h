// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/muscle_path.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "kinemark/stages/motion/scaling/place.h"
#include "kinemark/stages/motion/scaling/scale.h"

namespace kinemark::pipeline {

/// What `kinemark scale` is asked to do. Paths that are empty are not used. The options of a recording count
/// for the motion and for static trials, but for frames and times, which are the motion's; names that a
/// static trial beside a motion does not have are passed over there.
struct ScaleJob : JobSettings, RecordingOptions {
  std::filesystem::path model;         ///< .osim to scale
  std::filesystem::path setup;         ///< OpenSim ScaleTool file; fills what the other fields leave open
  std::filesystem::path static_trial;  ///< marker file of a static trial
  std::filesystem::path markers;       ///< marker file of a motion: sizes and positions are adapted to it
  std::filesystem::path joints;        ///< skeleton.json of a motion, or its folder
  std::filesystem::path output;        ///< M.osim; M_report.json goes beside it
  std::filesystem::path report;        ///< page to write as well, .html
  double mass_kg = 0.0;                ///< 0: the setup's, or as the factors make it
  bool dempster = false;               ///< distribute the mass by Dempster's fractions
  bool clavicles = false;              ///< set shoulders free first
  bool symmetric = false;              ///< one size for both sides
  double size_prior_sd = 0.1;          ///< of a segment's size against the model so far, share
  double position_prior_sd_m = 0.01;   ///< per axis; of a marker's position against the model so far
  double joint_prior_sd_m = 0.02;      ///< per axis; of a joint of `joints` against the model so far
  motion::AdaptOptions adapt;          ///< of the fit of sizes to a motion
  double max_rms_m = 0.05;             ///< quality gate: RMS distance of measured and model markers
};

/// A static trial that was judged before the model was moved onto it.
struct JudgedTrial {
  std::string file;                       ///< its name
  motion::FoundationJudgement judgement;  ///< markers elsewhere and exchanged pairs
};

/// Gates: static_trial (one each), marker_rms where markers were placed or followed.
struct ScaleOutcome : JobOutcome {
  data::ModelDescription model;                    ///< scaled, markers placed
  std::vector<JudgedTrial> static_trials;          ///< as they were judged
  std::optional<motion::ScaleResult> scaled;       ///< measured or set by hand, with a setup
  std::optional<motion::PlaceResult> placed;       ///< markers put where the static trial shows them
  std::optional<motion::AdaptResult> from_static;  ///< sizes from a static trial without a setup
  std::optional<motion::AdaptResult> from_motion;  ///< sizes and positions from the motion
  std::vector<data::BodyFactors> factors;          ///< of every body, all steps together
  std::vector<std::string> clavicles;              ///< set free
  std::vector<std::string> joints;                 ///< of `joints`, that are joints of the model
  std::vector<data::PathScale> muscles;            ///< lengths of muscles and ligaments, before and after
  std::vector<std::string> lost;                   ///< what the file held and the output does not
};

/// Judge static trials, scale, place, adapt, weigh and write, in this order; each step only where its input
/// is given. A static trial is judged against the model as it was read, before sizes and markers move, and
/// against the motion where there is one. Without a setup the model first gets the subject's overall size
/// from distances between markers of one segment. Joints of `joints` may leave their position in the model so
/// far; their centres count as observations, but not where they were found in the very recording that is
/// adapted to, which tells them once already. Progress counts steps.
[[nodiscard]] Result<ScaleOutcome> run_scale(ScaleJob job);

}  // namespace kinemark::pipeline
