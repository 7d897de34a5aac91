// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/data/filtering.h"
#include "kinemark/io/osim/osim_document.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/files/skeleton_file.h"
#include "kinemark/pipeline/foundations/foundation_gate.h"
#include "kinemark/pipeline/scale/scale_json.h"
#include "kinemark/pipeline/scale/scale_page.h"
#include "kinemark/pipeline/scale/scale_recordings.h"
#include "kinemark/pipeline/scale/scale_setup_options.h"
#include "kinemark/stages/motion/scaling/clavicles.h"
#include "kinemark/stages/motion/scaling/masses.h"
#include "kinemark/stages/motion/scaling/measured_joints.h"
#include "kinemark/stages/motion/scaling/muscles.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// One run, step by step; every step moves outcome.model on.
class ScaleRun {
 public:
  explicit ScaleRun(ScaleJob job) : job_(std::move(job)) {
    job_.adapt.threads = job_.threads;
    job_.adapt.ik.seed = job_.seed;
    const auto& times = job_.selection;
    if (std::isfinite(times.first_time_s)) job_.adapt.ik.first_time_s = times.first_time_s;
    if (std::isfinite(times.last_time_s)) job_.adapt.ik.last_time_s = times.last_time_s;
  }

  Status read_setup() {
    if (job_.setup.empty()) return {};
    auto setup = io::read_scale_setup(job_.setup);
    if (!setup) return std::unexpected(setup.error());
    setup_ = std::move(*setup);
    out_.warnings = setup_->notes;
    if (job_.model.empty()) job_.model = setup_->model_file;
    if (job_.output.empty() && !setup_->output_model_file.empty()) {
      if (auto s = check_below(job_.setup, setup_->output_model_file, "output_model_file"); !s) return s;
      job_.output = setup_->output_model_file;
    }
    if (job_.mass_kg == 0.0) job_.mass_kg = setup_->recipe.mass_kg;
    return {};
  }

  Status check() const {
    if (job_.model.empty()) return fail(Code::usage, "no model; give --model or a --setup that names one");
    if (job_.output.empty()) return fail(Code::usage, "no output; give --output or a --setup that names one");
    if (auto s = check_ending(job_.output, {".osim"}, "a model is"); !s) return s;
    if (auto s = check_ending(job_.report, {".html"}, "a page is"); !s) return s;
    if (job_.setup.empty() && job_.static_trial.empty() && job_.markers.empty())
      return fail(Code::usage, "nothing to scale by; give --static, --setup or --markers");
    if (!std::isfinite(job_.mass_kg) || job_.mass_kg < 0.0)
      return fail(Code::usage, fmt::format("a mass of {} kg; need a number above 0", job_.mass_kg));
    if (auto s = job_.RecordingOptions::check(); !s) return s;
    if (auto s = check_for_several(job_); !s && count() > 1) return s;
    if (job_.dempster && job_.mass_kg == 0.0)
      return fail(Code::usage, "Dempster's fractions need the body mass; give --mass");
    if (!job_.joints.empty() && !adapts())
      return fail(Code::usage,
                  "functional joints place those of a model that is adapted; give --static or "
                  "--markers besides --joints");
    for (const double sd : {job_.size_prior_sd, job_.position_prior_sd_m, job_.joint_prior_sd_m})
      if (!(sd > 0.0 && sd <= 1.0))
        return fail(Code::usage, fmt::format("a prior of {}; need above 0, at most 1", sd));
    return {};
  }

  Status read_model() {
    auto document = io::OsimDocument::read(job_.model);
    if (!document) return std::unexpected(document.error());
    out_.model = document->model();
    document_ = std::move(*document);
    if (setup_ && !setup_->marker_set_file.empty()) {
      auto set = io::read_marker_set(setup_->marker_set_file);
      if (!set) return std::unexpected(set.error());
      marker_set_ = std::move(*set);
      if (auto s = io::merge_markers(out_.model, marker_set_); !s)
        return fail_at(setup_->marker_set_file.string(), s.error());
    }
    if (out_.model.markers.empty())
      return fail(
          Code::bad_input,
          fmt::format("{}: model '{}' has no markers; need at least one, or a setup with a marker set",
                      job_.model.string(), out_.model.name));
    if (job_.clavicles) {
      auto moving = motion::add_clavicles(out_.model);
      if (!moving) return fail_at(job_.model.string(), moving.error());
      out_.clavicles = std::move(*moving);
    }
    for (const auto& body : out_.model.bodies) out_.factors.push_back({.body = body.name});
    return {};
  }

  /// The centres of `joints` that are joints of the model.
  Status read_joints() {
    if (job_.joints.empty()) return {};
    auto file = read_skeleton(job_.joints);
    if (!file) return std::unexpected(file.error());
    recording_of_joints_ = file->recording.hash;
    auto found = motion::match_joints(out_.model, file->skeleton);
    job_.adapt.joints = std::move(found.joints);
    out_.joints = std::move(found.names);
    for (const auto& sentence : found.left_out)
      out_.warnings.push_back(fmt::format("{}: {}", job_.joints.string(), sentence));
    if (out_.joints.empty())
      out_.warnings.push_back(fmt::format(
          "{}: none of its joints is one of the model; sizes alone place them", job_.joints.string()));
    return {};
  }

  /// Static trials against the model as it is, before anything moves.
  Status judge_static_trials() {
    std::vector<fs::path> files;
    if (!job_.static_trial.empty()) files.push_back(job_.static_trial);
    if (setup_ && job_.static_trial.empty()) {
      if (setup_->recipe.measures()) files.push_back(setup_->scale_marker_file);
      if (setup_->place && (files.empty() || setup_->place_marker_file != files.front()))
        files.push_back(setup_->place_marker_file);
    }
    std::erase_if(files, [](const fs::path& file) { return file.empty(); });
    if (files.empty()) return {};
    const auto body = motion::body_of_model(out_.model);
    if (!body) return fail_at(job_.model.string(), body.error());
    std::vector<const data::Trajectories*> movements;
    data::Trajectories motion;
    if (!job_.markers.empty()) {
      if (auto s = read_markers(job_.markers, motion); !s) return s;
      movements.push_back(&motion);
    }
    for (const auto& file : files) {
      data::Trajectories still;
      if (auto s = read_markers(file, still); !s) return s;
      const std::string name = file.filename().string();
      auto judgement = judge_static_trial(name, *body, still, movements, out_);
      if (!judgement) return std::unexpected(judgement.error());
      out_.static_trials.push_back({.file = name, .judgement = std::move(*judgement)});
    }
    return {};
  }

  Status scale_by_setup() {
    if (!setup_) return {};
    data::ScaleRecipe recipe = setup_->recipe;
    recipe.mass_kg = job_.mass_kg;
    data::Trajectories recording;
    const bool measures = recipe.measures();
    if (measures)
      if (auto s = read_trial(setup_->scale_marker_file, "the measurements of the setup", recording, true);
          !s)
        return s;
    auto scaled = motion::scale_model(out_.model, measures ? &recording : nullptr, recipe);
    if (!scaled) return fail_at(job_.setup.string(), scaled.error());
    out_.model = scaled->model;
    for (std::size_t b = 0; b < out_.factors.size(); ++b)
      out_.factors[b].factors = scaled->factors[b].factors;
    out_.scaled = std::move(*scaled);
    if (!setup_->place) return {};
    data::Trajectories trial;
    if (auto s = read_trial(setup_->place_marker_file, "the MarkerPlacer of the setup", trial, true); !s)
      return s;
    auto options_of_placer = place_options(*setup_, marker_set_, out_.model);
    if (!options_of_placer) return fail_at(job_.setup.string(), options_of_placer.error());
    return place(trial, *options_of_placer);
  }

  /// Sizes as far as one pose determines them, then the marker positions.
  Status scale_by_static_trial() {
    if (job_.static_trial.empty() || setup_) return {};
    data::Trajectories trial;
    if (auto s = read_trial(job_.static_trial, "scaling", trial); !s) return s;
    if (auto s = take_overall_size(trial); !s) return fail_at(job_.static_trial.string(), s.error());
    auto options = job_.adapt;
    options.ik.first_time_s = -1e300;
    options.ik.last_time_s = 1e300;
    options.max_frames = std::min<std::int64_t>(options.max_frames, 50);
    options.soft_tissue = false;  // one posture cannot tell what follows the posture
    auto adapted = adapt(trial, job_.static_trial, options);
    if (!adapted) return fail_at(job_.static_trial.string(), adapted.error());
    out_.from_static = std::move(*adapted);
    return place(trial, {});
  }

  Status adapt_to_motion() {
    if (job_.markers.empty()) return {};
    data::Trajectories trial;
    if (auto s = read_trial(job_.markers, "adapting the model", trial); !s) return s;
    if (!setup_ && job_.static_trial.empty())
      if (auto s = take_overall_size(trial); !s) return fail_at(job_.markers.string(), s.error());
    auto adapted = adapt(trial, job_.markers, job_.adapt);
    if (!adapted) return fail_at(job_.markers.string(), adapted.error());
    out_.from_motion = std::move(*adapted);
    return {};
  }

  Status weigh() {
    if (job_.mass_kg == 0.0) return {};
    const auto s = job_.dempster ? motion::distribute_mass(out_.model, job_.mass_kg)
                                 : motion::set_total_mass(out_.model, job_.mass_kg);
    return s ? s : Status(fail_at(job_.model.string(), s.error()));
  }

  /// How well markers fit, where something was placed by them.
  Status judge() {
    if (!out_.from_motion && !out_.placed) return {};
    const double rms = out_.from_motion ? out_.from_motion->rms_after_m : out_.placed->rms_m;
    out_.gates.push_back(
        {.name = "marker_rms",
         .passed = rms <= job_.max_rms_m,
         .value = 1e3 * rms,
         .bound = 1e3 * job_.max_rms_m,
         .unit = "mm",
         .sentence = fmt::format("The RMS distance between measured and model markers is {:.1f} mm; at most "
                                 "{:.1f} mm is accepted.",
                                 1e3 * rms, 1e3 * job_.max_rms_m)});
    if (!out_.gates.back().passed) out_.warnings.push_back(out_.gates.back().sentence);
    return {};
  }

  /// Muscles follow the bodies that they run over.
  Status scale_muscles() {
    if (!document_->paths_error().empty()) {
      out_.warnings.push_back(fmt::format(
          "The lengths of muscles at rest stay as they are, because their paths cannot be read: {}",
          document_->paths_error()));
      return {};
    }
    auto scales = motion::scale_paths(document_->model(), out_.model, document_->paths(), factors());
    if (!scales) return fail_at(job_.model.string(), scales.error());
    out_.muscles = std::move(*scales);
    std::vector<std::string> wrapped;
    for (const auto& muscle : out_.muscles)
      if (muscle.wraps) wrapped.push_back(muscle.name);
    if (!wrapped.empty())
      out_.warnings.push_back(
          fmt::format("Lengths at rest follow paths that bend around cylinders only; these may also meet "
                      "other surfaces: {}",
                      join(wrapped)));
    return {};
  }

  Result<ScaleOutcome> write() {
    const fs::path report = beside(job_.output, "_report.json");
    const auto text = document_->format({.model = out_.model, .factors = factors(), .paths = out_.muscles});
    if (!text) return fail_at(job_.output.string(), text.error());
    out_.lost = text->lost;
    auto staging = Staging::create(targets(), job_, inputs());
    if (!staging) return std::unexpected(staging.error());
    std::vector<ResultFile> files{model_file(job_.output, text->text),
                                  json_file(report, [this] { return scale_json(job_, out_); })};
    if (!job_.report.empty())
      files.push_back(text_file(job_.report, [this] { return scale_page(job_, out_); }));
    auto written = write_results(*staging, files, {}, "scaling", name_set(text->text));
    if (!written) return std::unexpected(written.error());
    out_.written = std::move(*written);
    return std::move(out_);
  }

  /// Checks that the targets can be written before any long computation.
  Status check_targets() const {
    const auto staging = Staging::create(targets(), job_, inputs());
    if (!staging) return std::unexpected(staging.error());
    return {};
  }

 private:
  /// Whether sizes and positions are found by inverse kinematics.
  bool adapts() const { return !job_.markers.empty() || (!job_.static_trial.empty() && !setup_); }

  /// Every file that is written.
  std::vector<fs::path> targets() const {
    std::vector<fs::path> files{job_.output, beside(job_.output, "_report.json")};
    if (!job_.report.empty()) files.push_back(job_.report);
    return files;
  }

  /// Name of the set of files. @param text  of the model
  std::string name_set(const std::string& text) const {
    SetDigest digest;
    digest.add("scale").add(text);
    for (const auto& gate : out_.gates) digest.add(gate.name).add(std::array{gate.value, gate.bound});
    for (const auto& factor : out_.factors)
      digest.add(std::array{factor.factors.x(), factor.factors.y(), factor.factors.z()});
    return digest.hex();
  }

  /// Of the bodies that the file has.
  std::vector<Vector3d> factors() const {
    std::vector<Vector3d> factors(document_->model().bodies.size());
    for (std::size_t b = 0; b < factors.size(); ++b) factors[b] = out_.factors[b].factors;
    return factors;
  }

  /// Every file that is read.
  std::vector<fs::path> inputs() const {
    std::vector<fs::path> files{job_.model, job_.setup, job_.joints, job_.joints / "skeleton.json"};
    for (const auto& recording : {job_.static_trial, job_.markers})
      std::ranges::move(files_of(recording, job_), std::back_inserter(files));
    if (!setup_) return files;
    files.insert(files.end(), {setup_->marker_set_file, setup_->coordinate_file});
    for (const auto& recording : {setup_->scale_marker_file, setup_->place_marker_file})
      std::ranges::move(files_of(recording, job_), std::back_inserter(files));
    files.insert(files.end(), setup_->parts.begin(), setup_->parts.end());
    return files;
  }

  /// --static takes precedence over the file named by the setup.
  Status read_trial(const fs::path& named, const char* what, data::Trajectories& out, bool by_setup = false) {
    const fs::path& path = by_setup && !job_.static_trial.empty() ? job_.static_trial : named;
    if (path.empty())
      return fail(Code::usage, fmt::format("{} needs a marker file; give --static or name it there", what));
    auto recording = open_scale_recording(job_, count(), path);
    if (!recording) return std::unexpected(recording.error());
    const auto model = model::Model::compile(out_.model);
    if (!model) return fail_at(job_.model.string(), model.error());
    const auto axes = workflow::bring_into_axes(job_.axes, path, recording->trial, *model);
    if (!axes) return std::unexpected(axes.error());
    if (const auto note = data::note_on_noise(recording->trial.markers); !note.empty()) say(path, note);
    for (const auto& note : recording->notes) say(path, note);
    if (!axes->note.empty()) say(path, axes->note);
    out = std::move(recording->trial.markers);
    return {};
  }

  void say(const fs::path& path, const std::string& note) {
    auto sentence = fmt::format("{}: {}", path.string(), note);
    if (std::ranges::find(out_.warnings, sentence) == out_.warnings.end())
      out_.warnings.push_back(std::move(sentence));
  }

  [[nodiscard]] std::size_t count() const { return count_recordings(job_, setup_ ? &*setup_ : nullptr); }

  /// As the file has them: a judge turns them itself.
  Status read_markers(const fs::path& path, data::Trajectories& out) const {
    auto recording = open_scale_recording(job_, count(), path);
    if (!recording) return std::unexpected(recording.error());
    out = std::move(recording->trial.markers);
    return {};
  }

  Status place(const data::Trajectories& trial, const motion::PlaceOptions& options) {
    auto placed = motion::place_markers(out_.model, trial, options);
    if (!placed) return fail_at((setup_ ? job_.setup : job_.static_trial).string(), placed.error());
    out_.model = placed->model;
    out_.placed = std::move(*placed);
    return {};
  }

  /// One factor for the whole model, from distances between markers of one body.
  Status take_overall_size(const data::Trajectories& trial) {
    const auto size = motion::find_overall_size(out_.model, trial);
    if (!size) return std::unexpected(size.error());
    std::vector<Vector3d> factors(out_.model.bodies.size(), Vector3d::Constant(*size));
    motion::apply_factors(out_.model, factors, true);
    for (auto& factor : out_.factors) factor.factors *= *size;
    return {};
  }

  /// Joints that were found in this very recording are found with the sizes: their centres would count twice.
  Result<motion::AdaptResult> adapt(const data::Trajectories& trial, const fs::path& file,
                                    motion::AdaptOptions options) {
    if (!job_.joints.empty()) {
      const auto hash = hash_file(file);
      if (!hash) return std::unexpected(hash.error());
      if (hash->hex == recording_of_joints_) options.joints.clear();
    }
    const auto groups = motion::default_scale_groups(out_.model, job_.symmetric);
    auto parameters = motion::scale_parameters(out_.model, groups, job_.size_prior_sd);
    if (!parameters) return std::unexpected(parameters.error());
    const std::size_t sizes = parameters->size();
    const auto positions = motion::marker_parameters(out_.model, {}, job_.position_prior_sd_m);
    if (!positions) return std::unexpected(positions.error());
    parameters->insert(parameters->end(), positions->begin(), positions->end());
    if (!out_.joints.empty()) {
      const auto joints = motion::joint_parameters(out_.model, out_.joints, job_.joint_prior_sd_m);
      if (!joints) return std::unexpected(joints.error());
      parameters->insert(parameters->end(), joints->begin(), joints->end());
    }
    auto adapted = motion::adapt_model(out_.model, trial, *parameters, options, job_.progress);
    if (!adapted) return adapted;
    // The bodies' own sizes carry their mass centres and inertias along; masses follow the volume.
    std::vector<Vector3d> factors(out_.model.bodies.size(), Vector3d::Ones());
    for (std::size_t k = 0; k < sizes; ++k)
      for (const auto& group : groups)
        for (const auto& part : group.parts)
          if (group.name == adapted->parameters[k].name)
            factors[at(out_.model.find_body(part.body))] +=
                (adapted->parameters[k].value - adapted->parameters[k].initial) * part.axes;
    data::ModelDescription stretched = out_.model;
    motion::apply_factors(stretched, factors, true);
    out_.model = adapted->model;
    out_.model.bodies = stretched.bodies;
    for (std::size_t b = 0; b < factors.size(); ++b)
      out_.factors[b].factors = out_.factors[b].factors.cwiseProduct(factors[b]);
    return adapted;
  }

  ScaleJob job_;
  std::optional<io::OsimDocument> document_;
  std::optional<io::ScaleSetup> setup_;
  std::vector<io::MarkerOfSet> marker_set_;
  std::string recording_of_joints_;  ///< checksum; empty: not known
  ScaleOutcome out_;
};

}  // namespace

Result<ScaleOutcome> run_scale(ScaleJob job) {
  ScaleRun run(std::move(job));
  for (const auto step :
       {&ScaleRun::read_setup, &ScaleRun::read_model, &ScaleRun::read_joints, &ScaleRun::judge_static_trials,
        &ScaleRun::scale_by_setup, &ScaleRun::scale_by_static_trial, &ScaleRun::adapt_to_motion,
        &ScaleRun::weigh, &ScaleRun::scale_muscles, &ScaleRun::judge}) {
    if (auto s = (run.*step)(); !s) return std::unexpected(s.error());
    if (step != &ScaleRun::read_setup) continue;
    if (auto s = run.check(); !s) return std::unexpected(s.error());
    if (auto s = run.check_targets(); !s) return std::unexpected(s.error());
  }
  return run.write();
}

}  // namespace kinemark::pipeline
