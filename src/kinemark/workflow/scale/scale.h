// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A model made to fit a subject: by a static trial, by a recipe of distances, by a motion, in this order.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/muscle_path.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/scale_recipe.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "kinemark/stages/motion/scaling/place.h"
#include "kinemark/stages/motion/scaling/scale.h"
#include "kinemark/workflow/prepare/axes.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// How a model is scaled.
struct ScaleMethod {
  double mass_kg = 0.0;               ///< of the subject; 0: the recipe's, or as the factors make it
  bool dempster = false;              ///< distribute the mass by Dempster's fractions
  bool clavicles = false;             ///< set shoulders free first
  bool symmetric = false;             ///< one size for both sides
  double size_prior_sd = 0.1;         ///< of a segment's size against the model so far, share
  double position_prior_sd_m = 0.01;  ///< per axis; of a marker's position against the model so far
  double joint_prior_sd_m = 0.02;     ///< per axis; of a measured joint against the model so far
  motion::AdaptOptions adapt;         ///< of the fit of sizes; its `joints` are set by scale()
  double max_rms_m = 0.05;            ///< quality gate: RMS distance of measured and model markers

  /// Code::usage for a mass below 0 or none for Dempster's fractions, for priors that are not above 0 and at
  /// most 1. @param recipe_mass_kg  of a recipe beside it; 0: none
  [[nodiscard]] Status check(double recipe_mass_kg = 0.0) const;
};

/// What is asked of scale().
struct ScaleOptions : ScaleMethod {
  /// Factors from distances between markers, or given by hand; none: sizes are found from the static trial.
  std::optional<data::ScaleRecipe> recipe;
  /// Beside a recipe: how markers are put where the static trial shows them; none: they stay. Without a
  /// recipe all of them are put there.
  std::optional<motion::PlaceOptions> place;
  AxesChoice axes;             ///< how recordings are turned into the model's axes
  bool drop_doubtful = false;  ///< samples that are surely swapped, stuck or false are not used
  Progress progress;           ///< steps of a fit
};

/// A recording that a model is scaled by, and what sentences call it.
struct ScaleTrial {
  data::Recording recording;  ///< in its own axes
  std::string name;           ///< within a sentence, "cal.c3d"
  std::string where = {};     ///< in front of one, "session/cal.c3d"; empty: the name
  bool holds_joints = false;  ///< the measured joints were found in it: their centres would count twice
};

/// What errors and sentences call the rest.
struct ScaleNames {
  std::string model = "the model";        ///< in front of errors that it causes
  std::string recipe = "the recipe";      ///< in front of errors that it causes
  std::string skeleton = "the skeleton";  ///< in front of joints that are not used
};

/// What a model is scaled by. All may be absent but one of static trial, motion and a recipe that measures
/// nothing.
struct ScaleInputs {
  std::optional<ScaleTrial> still = {};     ///< static trial
  std::optional<ScaleTrial> measured = {};  ///< where the recipe measures; none: in the static trial
  std::optional<ScaleTrial> motion = {};    ///< sizes and positions are adapted to it in the end
  std::optional<data::Skeleton> joints =
      {};  ///< their centres count as observations of the joints of the model
  std::vector<data::MusclePath> paths = {};  ///< of the model's muscles and ligaments
  std::string paths_fault = {};  ///< why paths that are there could not be read; empty: they could
  ScaleNames names = {};         ///< what sentences call them
};

/// A static trial that was judged before the model was moved onto it.
struct JudgedTrial {
  std::string file;                       ///< its name
  motion::FoundationJudgement judgement;  ///< markers elsewhere and exchanged pairs
};

/// Gates: static_trial (one each), sizes, marker_rms where markers were placed or followed.
struct ScaleFound {
  data::ModelDescription model;                    ///< scaled, markers placed
  std::vector<JudgedTrial> static_trials;          ///< as they were judged
  std::optional<motion::ScaleResult> scaled;       ///< measured or set by hand, with a recipe
  std::optional<motion::PlaceResult> placed;       ///< markers put where the static trial shows them
  std::optional<motion::AdaptResult> from_static;  ///< sizes from a static trial without a recipe
  std::optional<motion::AdaptResult> from_motion;  ///< sizes and positions from the motion
  std::vector<data::BodyFactors> factors;          ///< of every body, all steps together
  std::vector<std::string> clavicles;              ///< set free
  std::vector<std::string> joints;                 ///< measured ones that are joints of the model
  std::vector<data::PathScale> muscles;            ///< lengths of muscles and ligaments, before and after
  Remarks remarks;                                 ///< of the recordings and the fit
};

/// Judge static trials, scale, place, adapt, weigh, in this order; each step only where its input is given. A
/// static trial is judged against the model as it is given, before sizes and markers move, and against the
/// motion where there is one. Without a recipe the model first gets the subject's overall size from distances
/// between markers of one segment. Joints that were measured may leave their position in the model so far.
/// Frames that a recorder made between those that it measured are left out, which is said.
///
/// A failure after a static trial with findings ends with them. Code::usage as ScaleMethod::check() and where
/// an input is missing, or is there without a use. Else fails, naming what it is of, as screen_markers(),
/// bring_into_axes() of prepare, motion::scale_model(), place_markers(), adapt_model(), add_clavicles(),
/// scale_paths(). About 1 ms per frame and step for a whole body.
[[nodiscard]] Result<ScaleFound> scale(const data::ModelDescription& model, ScaleInputs inputs,
                                       const ScaleOptions& options = {});

}  // namespace kinemark::workflow
