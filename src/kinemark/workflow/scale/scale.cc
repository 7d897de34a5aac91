// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/scale/scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/filtering.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/foundations/standing_body.h"
#include "kinemark/stages/motion/scaling/clavicles.h"
#include "kinemark/stages/motion/scaling/measured_joints.h"
#include "kinemark/workflow/foundations/foundation_gate.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/scale/internal/grow.h"
#include "kinemark/workflow/scale/internal/sizes.h"

namespace kinemark::workflow {
namespace {

// Recordings as they meet the model.

void say(const std::string& where, const std::string& note, std::vector<std::string>& warnings) {
  auto sentence = fmt::format("{}: {}", where, note);
  if (std::ranges::find(warnings, sentence) == warnings.end()) warnings.push_back(std::move(sentence));
}

/// Frames that the recorder made between those that it measured are left out, which is a note: a fit would
/// take them for measurements of their own. Fails as screen_markers(), naming the trial.
Status keep_measured(ScaleTrial& trial) {
  auto& recording = trial.recording;
  const auto made = note_on_upsampling(recording.trial.markers);
  if (!made) return fail_at(trial.where, made.error());
  if (made->empty()) return {};
  const auto screening =
      screen_markers(recording.trial, {.recorder_made = RecorderMade::decimate, .find_defects = false});
  if (!screening) return fail_at(trial.where, screening.error());
  if (screening->upsampling->factor() > 1)
    recording.notes.push_back(*made + "; sizes are found from measured frames alone");
  return {};
}

/// Samples that are surely swapped, stuck or false are left out. Fails as leave_out_defects(), naming the
/// trial.
Status leave_out_doubtful(ScaleTrial& trial) {
  auto& recording = trial.recording;
  const auto s = leave_out_defects(recording.trial, false, recording.edits.swapped, recording.notes);
  return s ? s : Status(fail_at(trial.where, s.error()));
}

/// The still recordings against a model, before anything moves, and against the motion where there is one:
/// each as its file has it, as a judge turns them itself. Static trials and remarks of `found` grow.
Status judge_stills(const std::vector<const ScaleTrial*>& stills, const std::optional<ScaleTrial>& motion,
                    const std::string& model_name, ScaleFound& found) {
  if (stills.empty() && !motion) return {};
  const auto body = motion::body_of_model(found.model);
  if (!body) return fail_at(model_name, body.error());
  std::vector<const data::Trajectories*> movements;
  if (motion) {
    movements.push_back(&motion->recording.trial.markers);
    add_contradictions(motion->recording.contradicted, found.remarks.gates);
  }
  for (const auto* still : stills) {
    add_contradictions(still->recording.contradicted, found.remarks.gates);
    auto judgement =
        judge_static_trial(still->name, *body, still->recording.trial.markers, movements, found.remarks);
    if (!judgement) return std::unexpected(judgement.error());
    found.static_trials.push_back({.file = still->name, .judgement = std::move(*judgement)});
  }
  return {};
}

/// A recording is turned into the axes of the model so far; what its samples went through and what was done
/// to it are said, each sentence once.
Status bring_to_model(const AxesChoice& axes, const std::string& model_name, ScaleTrial& trial,
                      ScaleFound& found) {
  const auto model = model::Model::compile(found.model);
  if (!model) return fail_at(model_name, model.error());
  auto& recording = trial.recording;
  const auto brought = bring_into_axes(axes, trial.where, recording.trial, *model);
  if (!brought) return std::unexpected(brought.error());
  auto& warnings = found.remarks.warnings;
  if (const auto note = data::note_on_noise(recording.trial.markers); !note.empty())
    say(trial.where, note, warnings);
  for (const auto& note : recording.notes) say(trial.where, note, warnings);
  if (!brought->note.empty()) say(trial.where, brought->note, warnings);
  return {};
}

constexpr std::int64_t kFramesOfPosture = 50;  // of a static trial: one posture, seen often enough

Status check_inputs(const ScaleInputs& inputs, const ScaleOptions& options) {
  const bool measures = options.recipe && options.recipe->measures();
  if (!inputs.still && !inputs.motion && !options.recipe)
    return fail(Code::usage, "nothing to scale by; give a static trial, a recipe or a motion");
  if (inputs.measured && !measures)
    return fail(Code::usage, "a recording to measure in, but no recipe that measures");
  if (measures && !inputs.measured && !inputs.still)
    return fail(Code::usage, "a recipe that measures, but no recording to measure in");
  if (options.place && !options.recipe)
    return fail(Code::usage, "how markers are placed is asked beside a recipe only");
  if (inputs.still && options.recipe && !options.place && !(measures && !inputs.measured))
    return fail(Code::usage,
                "a static trial, but the recipe neither measures in it nor places markers by it");
  if (options.place && !inputs.still)
    return fail(Code::usage, "markers are to be placed, but there is no static trial");
  if (inputs.joints && !inputs.motion && (!inputs.still || options.recipe))
    return fail(Code::usage,
                "measured joints place those of a model that is adapted to a motion, or to a "
                "static trial without a recipe");
  return {};
}

/// One run, step by step; every step moves the model of `found_` on.
class Scaling {
 public:
  Scaling(const data::ModelDescription& model, ScaleInputs inputs, const ScaleOptions& options)
      : given_(model), in_(std::move(inputs)), options_(options) {
    found_.model = model;
  }

  /// Recordings without what does not count, shoulders set free, factors of 1.
  Status begin() {
    for (auto* trial : {&in_.still, &in_.measured, &in_.motion}) {
      if (!*trial) continue;
      if ((*trial)->where.empty()) (*trial)->where = (*trial)->name;
      if (auto s = keep_measured(**trial); !s) return s;
      if (options_.drop_doubtful)
        if (auto s = leave_out_doubtful(**trial); !s) return s;
    }
    if (options_.clavicles) {
      auto moving = motion::add_clavicles(found_.model);
      if (!moving) return fail_at(in_.names.model, moving.error());
      found_.clavicles = std::move(*moving);
    }
    for (const auto& body : found_.model.bodies) found_.factors.push_back({.body = body.name});
    return {};
  }

  /// The measured joints that are joints of the model.
  Status match_joints() {
    if (!in_.joints) return {};
    auto matched = motion::match_joints(found_.model, *in_.joints);
    joints_ = std::move(matched.joints);
    found_.joints = std::move(matched.names);
    auto& warnings = found_.remarks.warnings;
    for (const auto& sentence : matched.left_out)
      warnings.push_back(fmt::format("{}: {}", in_.names.skeleton, sentence));
    if (found_.joints.empty())
      warnings.push_back(fmt::format("{}: none of its joints is one of the model; sizes alone place them",
                                     in_.names.skeleton));
    return {};
  }

  Status judge_static_trials() {
    std::vector<const ScaleTrial*> stills;
    if (in_.measured) stills.push_back(&*in_.measured);
    if (in_.still) stills.push_back(&*in_.still);
    return judge_stills(stills, in_.motion, in_.names.model, found_);
  }

  Status scale_by_recipe() {
    if (!options_.recipe) return {};
    auto recipe = *options_.recipe;
    recipe.mass_kg = mass_kg();
    const data::Trajectories* markers = nullptr;
    if (recipe.measures()) {
      auto& trial = in_.measured ? *in_.measured : *in_.still;
      if (auto s = bring(trial); !s) return s;
      markers = &trial.recording.trial.markers;
    }
    auto scaled = motion::scale_model(found_.model, markers, recipe);
    if (!scaled) return fail_at(in_.names.recipe, scaled.error());
    found_.model = scaled->model;
    for (std::size_t b = 0; b < found_.factors.size(); ++b)
      found_.factors[b].factors = scaled->factors[b].factors;
    found_.scaled = std::move(*scaled);
    if (!options_.place) return {};
    if (auto s = bring(*in_.still); !s) return s;
    return place(*options_.place, in_.names.recipe);
  }

  /// Sizes as far as one pose determines them, then the marker positions.
  Status scale_by_static_trial() {
    if (!in_.still || options_.recipe) return {};
    auto& trial = *in_.still;
    if (auto s = bring(trial); !s) return s;
    if (auto s = take_overall_size(trial.recording.trial.markers, found_); !s)
      return fail_at(trial.where, s.error());
    auto options = options_.adapt;
    options.ik.first_time_s = -1e300;
    options.ik.last_time_s = 1e300;
    options.max_frames = std::min(options.max_frames, kFramesOfPosture);
    options.soft_tissue = false;  // one posture cannot tell what follows the posture
    if (auto s = adapt(trial, options, found_.from_static); !s) return s;
    return place({}, trial.where);
  }

  Status adapt_to_motion() {
    if (!in_.motion) return {};
    auto& trial = *in_.motion;
    if (auto s = bring(trial); !s) return s;
    if (!options_.recipe && !in_.still)
      if (auto s = take_overall_size(trial.recording.trial.markers, found_); !s)
        return fail_at(trial.where, s.error());
    return adapt(trial, options_.adapt, found_.from_motion);
  }

  Status weigh_and_fit_muscles() {
    if (auto s = weigh(mass_kg(), options_.dempster, found_.model); !s)
      return fail_at(in_.names.model, s.error());
    if (auto s = scale_muscles(given_, in_, found_); !s) return fail_at(in_.names.model, s.error());
    return {};
  }

  /// Whether the factors of all steps together are those of a person.
  Status judge_factors() {
    std::vector<SizeSource> sources;
    for (const auto* trial : {&in_.measured, &in_.still, &in_.motion})
      if (*trial) sources.push_back({(*trial)->name, &(*trial)->recording.trial.markers});
    std::optional<RecipeSizes> recipe;
    if (found_.scaled && !sources.empty() && !found_.from_motion)
      recipe = {.recipe = &*options_.recipe, .scaled = &*found_.scaled, .trial = sources.front().name};
    const auto s = judge_sizes(given_, found_.factors, sources, recipe, found_.remarks);
    return s ? s : Status(fail_at(in_.names.model, s.error()));
  }

  /// A failure of a later step, with what was found in the static trials.
  [[nodiscard]] Error with_findings(Error error) const {
    for (const auto& gate : found_.remarks.gates)
      if (!gate.passed) error.message += ". " + gate.sentence;
    return error;
  }

  /// How well markers fit, where something was placed by them.
  Status judge_fit() {
    if (!found_.from_motion && !found_.placed) return {};
    const double rms = found_.from_motion ? found_.from_motion->rms_after_m : found_.placed->rms_m;
    auto& [warnings, gates] = found_.remarks;
    gates.push_back(
        {.name = "marker_rms",
         .passed = rms <= options_.max_rms_m,
         .value = 1e3 * rms,
         .bound = 1e3 * options_.max_rms_m,
         .unit = "mm",
         .sentence = fmt::format("The RMS distance between measured and model markers is {:.1f} mm; at most "
                                 "{:.1f} mm is accepted.",
                                 1e3 * rms, 1e3 * options_.max_rms_m)});
    if (!gates.back().passed) warnings.push_back(gates.back().sentence);
    return {};
  }

  void hold(const std::vector<std::string>& contradicted) {
    std::ranges::copy(contradicted, std::back_inserter(found_.remarks.warnings));
    add_contradictions(contradicted, found_.remarks.gates);
  }

  ScaleFound take() { return std::move(found_); }

 private:
  [[nodiscard]] double mass_kg() const {
    return options_.mass_kg == 0.0 && options_.recipe ? options_.recipe->mass_kg : options_.mass_kg;
  }

  /// Once: a recording that is measured in and placed by is turned when it is met first.
  Status bring(ScaleTrial& trial) {
    if (std::ranges::find(brought_, &trial) != brought_.end()) return {};
    brought_.push_back(&trial);
    return bring_to_model(options_.axes, in_.names.model, trial, found_);
  }

  Status place(const motion::PlaceOptions& options, const std::string& name) {
    auto placed = motion::place_markers(found_.model, in_.still->recording.trial.markers, options);
    if (!placed) return fail_at(name, placed.error());
    found_.model = placed->model;
    found_.placed = std::move(*placed);
    return {};
  }

  /// Joints that were measured in this very recording are found with the sizes.
  Status adapt(const ScaleTrial& trial, motion::AdaptOptions options,
               std::optional<motion::AdaptResult>& result) {
    options.joints.clear();
    if (!trial.holds_joints) options.joints = joints_;
    auto adapted = adapt_to(trial.recording.trial.markers, options_, options, options_.progress, found_);
    if (!adapted) return fail_at(trial.where, adapted.error());
    result = std::move(*adapted);
    return {};
  }

  const data::ModelDescription& given_;
  ScaleInputs in_;
  const ScaleOptions& options_;
  std::vector<motion::MeasuredJoint> joints_;
  std::vector<const ScaleTrial*> brought_;  ///< into the model's axes
  ScaleFound found_;
};

}  // namespace

Status ScaleMethod::check(double recipe_mass_kg) const {
  if (!std::isfinite(mass_kg) || mass_kg < 0.0)
    return fail(Code::usage, fmt::format("a mass of {} kg; need a number above 0", mass_kg));
  if (dempster && mass_kg == 0.0 && !(recipe_mass_kg > 0.0))
    return fail(Code::usage, "Dempster's fractions need the body mass; give --mass");
  for (const double sd : {size_prior_sd, position_prior_sd_m, joint_prior_sd_m})
    if (!(sd > 0.0 && sd <= 1.0))
      return fail(Code::usage, fmt::format("a prior of {}; need above 0, at most 1", sd));
  return {};
}

Result<ScaleFound> scale(const data::ModelDescription& model, ScaleInputs inputs,
                         const ScaleOptions& options) {
  if (auto s = options.check(options.recipe ? options.recipe->mass_kg : 0.0); !s)
    return std::unexpected(s.error());
  if (auto s = check_inputs(inputs, options); !s) return std::unexpected(s.error());
  Scaling scaling(model, std::move(inputs), options);
  scaling.hold(contradicted_model(model));
  for (const auto step :
       {&Scaling::begin, &Scaling::match_joints, &Scaling::judge_static_trials, &Scaling::scale_by_recipe,
        &Scaling::scale_by_static_trial, &Scaling::adapt_to_motion, &Scaling::judge_factors,
        &Scaling::weigh_and_fit_muscles, &Scaling::judge_fit})
    if (auto s = (scaling.*step)(); !s) return std::unexpected(scaling.with_findings(s.error()));
  return scaling.take();
}

}  // namespace kinemark::workflow
