// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/track_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/data/likely_pairs.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/motion/internal/adapted_body.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/scale/scale_json.h"
#include "kinemark/workflow/motion/track.h"

namespace kinemark::pipeline {
namespace {

std::string list(const std::vector<std::string>& names) { return names.empty() ? "none" : join(names); }

/// Why each marker of a level was chosen.
std::string describe_choice(const motion::LevelProposal& proposal, std::size_t level) {
  std::vector<std::string> words;
  for (std::size_t m = 0; m < proposal.smallest[level].size(); ++m)
    words.push_back(fmt::format("{} {:.2g}", proposal.levels[level].markers[m], proposal.smallest[level][m]));
  return fmt::format("smallest singular values in {} poses, kg^-1/2: {}", proposal.poses, join(words));
}

std::string describe_level(const motion::LevelAccount& level) {
  return fmt::format("{}, {:.2f} mm RMS from its goals, {:.2f} mm in its worst frame",
                     std::isnan(level.weight) ? fmt::format("strict, bound {:.1f} mm", 1e3 * level.bound_m)
                                              : fmt::format("weight {:.3g}", level.weight),
                     1e3 * level.rms_error_m, 1e3 * level.max_error_m);
}

std::vector<std::pair<std::string, std::string>> describe_options(const TrackJob& job,
                                                                  const motion::TrackResult& result) {
  const auto& o = job.options;
  const auto& levels = result.proposed ? result.proposed->levels : o.levels;
  std::vector<std::pair<std::string, std::string>> options{
      {"levels of priority", std::to_string(std::max<std::size_t>(1, levels.size()))}};
  for (std::size_t i = 0; i < levels.size(); ++i)
    options.emplace_back(fmt::format("level {}", i + 1), list(levels[i].names()));
  if (result.proposed)
    for (std::size_t i = 0; i < result.proposed->smallest.size(); ++i)
      options.emplace_back(fmt::format("level {} was proposed", i + 1), describe_choice(*result.proposed, i));
  for (std::size_t i = 0; i < result.levels.size(); ++i)
    options.emplace_back(fmt::format("level {} as followed", i + 1), describe_level(result.levels[i]));
  for (const auto& task : result.tasks) options.emplace_back("task " + task.text, describe_task(task));
  if (result.accuracy) {
    const auto& a = *result.accuracy;
    options.emplace_back("accuracy wanted", fmt::format("{:g} deg", kDegPerRad * a.wanted_rad));
    options.emplace_back("accuracy expected",
                         fmt::format("{:.3g} deg RMS; noise {:.2g}, lost movement {:.2g}, steps {:.2g} deg",
                                     kDegPerRad * a.predicted_rad, kDegPerRad * a.noise_rad,
                                     kDegPerRad * a.lost_rad, kDegPerRad * a.step_rad));
    options.emplace_back("largest, smallest expected",
                         fmt::format("{:.3g} deg in {}, {:.3g} deg in {}", kDegPerRad * a.largest_rad,
                                     a.largest, kDegPerRad * a.smallest_rad, a.smallest));
  }
  options.emplace_back(
      "gains", o.kp > 0.0 ? fmt::format("kp {:g} 1/s^2, kd {:g} 1/s", o.kp, o.kd)
                          : fmt::format("omega {:g} rad/s",
                                        result.accuracy ? result.accuracy->omega_rad_s : o.omega_rad_s));
  options.emplace_back("step", fmt::format("{:.4g} ms", 1e3 * result.step_s));
  options.emplace_back("damping", fmt::format("{:g}", o.damping));
  options.emplace_back("cut-off of the goals", result.accuracy
                                                   ? fmt::format("{:g} Hz", result.accuracy->cutoff_hz)
                                               : o.cutoff_hz > 0.0 ? fmt::format("{:g} Hz", o.cutoff_hz)
                                                                   : "none");
  options.emplace_back("feed-forward", o.feed_forward ? "on" : "off");
  options.emplace_back("posture", fmt::format("kp {:g} 1/s^2, kd {:g} 1/s", o.posture_kp, o.posture_kd));
  options.emplace_back("limits of clamped coordinates", o.limits ? "kept" : "ignored");
  options.emplace_back("outliers", o.judge_samples ? "left out" : "kept");
  if (job.images.any()) options.emplace_back("images in the lowest level", describe_images(job.images));
  options.emplace_back("determined in fewer than 95 % of the frames",
                       o.error_bars ? list(result.undetermined_coordinates) : "not known without error bars");
  return options;
}

Result<report::IkRun> describe_run(const TrackJob& job, const internal::MotionInputs& inputs,
                                   const workflow::TrackFound& found) {
  const auto& result = found.result;
  auto run = internal::begin_run(job, inputs);
  run.method = "direct marker control";
  std::ranges::move(describe_options(job, result), std::back_inserter(run.options));
  run.solve_s = result.solve_seconds;
  internal::add_found(run, result.fit, found.torques, found.remarks);
  run.locked_coordinates.insert(run.locked_coordinates.end(), result.locked_coordinates.begin(),
                                result.locked_coordinates.end());
  return run;
}

/// Rank of all levels, frame by frame.
data::Table rank_table(const motion::TrackResult& result) {
  data::Table table;
  table.name = "Rank of the tasks";
  table.columns = {"rank", "smallest_singular_value"};
  for (std::int64_t f = 0; f < result.motion.frames(); ++f) {
    const auto i = static_cast<std::size_t>(f);
    table.time_s.push_back(result.motion.time.time_s(f));
    table.values.insert(table.values.end(),
                        {static_cast<double>(result.rank[i]), result.smallest_singular[i]});
  }
  return table;
}

/// Distances of levels to their goals, frame by frame, and whether strict ones were relaxed.
data::Table levels_table(const motion::TrackResult& result) {
  data::Table table;
  table.name = "Levels";
  for (std::size_t i = 0; i < result.levels.size(); ++i)
    table.columns.push_back(fmt::format("level_{}_mm", i + 1));
  table.columns.emplace_back("relaxed");
  const std::size_t L = result.levels.size();
  for (std::size_t f = 0; f < result.relaxed.size(); ++f) {
    table.time_s.push_back(result.motion.time.time_s(static_cast<std::int64_t>(f)));
    for (std::size_t i = 0; i < L; ++i) table.values.push_back(1e3 * result.level_error[f * L + i]);
    table.values.push_back(result.relaxed[f]);
  }
  return table;
}

/// What the sizes are worth belongs to the run; gates of one name count once.
void add_adapted(const internal::AdaptedBody& body, workflow::TrackFound& found) {
  motion::add_geometry_error(body.result, found.result.motion);
  auto& [warnings, gates] = found.remarks;
  std::ranges::copy(body.remarks.warnings, std::back_inserter(warnings));
  std::ranges::copy(body.result.recommendations, std::back_inserter(warnings));
  std::ranges::copy(body.lost, std::back_inserter(warnings));
  for (const auto& gate : body.remarks.gates)
    if (std::ranges::find(gates, gate.name, &data::Gate::name) == gates.end()) gates.push_back(gate);
}

Result<Staging> stage_files(const TrackJob& job) {
  std::vector<std::string> files{"_tau.sto", "_rank.sto", "_marker_errors.sto"};
  if (job.options.levels.size() > 1 || job.options.propose_levels) files.emplace_back("_levels.sto");
  if (job.options.error_bars) files.insert(files.end(), {"_sd.sto", "_bound.sto", "_tau_sd.sto"});
  if (job.adapt) files.emplace_back(internal::kAdaptedModel);
  files.push_back("_report.json");
  std::vector<std::filesystem::path> further;
  if (!job.report.empty()) further.push_back(job.report);
  return internal::stage(job, files, further);
}

}  // namespace

std::string describe_proposal(const motion::LevelProposal& proposal) {
  std::vector<std::string> words;
  for (const auto& level : proposal.levels)
    words.push_back("--level " + data::for_shell(join(level.markers, ",")));
  return join(words, " ");
}

std::string describe_task(const motion::TaskAccount& task) {
  if (std::isnan(task.rms_error)) return "no goal in any frame";
  const double unit = task.is_angle ? kDegPerRad : 1e3;
  return fmt::format("{:.3g} {} RMS from its goal, {:.3g} {} at most", unit * task.rms_error,
                     task.is_angle ? "deg" : "mm", unit * task.max_error, task.is_angle ? "deg" : "mm");
}

Result<TrackOutcome> run_track(TrackJob job) {
  // Prepare: options, model and markers, where results go.
  job.options.threads = job.threads;
  job.options.seed = job.seed;
  internal::take_recording_options(job, job.options);
  if (auto s = internal::check_named(job); !s) return std::unexpected(s.error());
  if (auto s = internal::check_output_named(job); !s) return std::unexpected(s.error());
  if (auto s = check_ending(job.report, {".html"}, "a page is"); !s) return std::unexpected(s.error());
  if (auto s = job.options.check(); !s) return std::unexpected(s.error());
  auto staging = stage_files(job);
  if (!staging) return std::unexpected(staging.error());
  auto inputs = internal::read_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  // Solve.
  std::optional<internal::AdaptedBody> body;
  if (job.adapt) {
    auto adapted = internal::adapt_body(job, *inputs);
    if (!adapted) return std::unexpected(adapted.error());
    body = std::move(*adapted);
  }
  auto found = workflow::track(
      inputs->model, inputs->recording,
      {.track = job.options, .bounds = job, .images = inputs->image_tracks(), .progress = job.progress});
  if (!found) {
    if (found.error().code == Code::usage) return std::unexpected(found.error());
    return fail_at(job.markers.string(), found.error());
  }
  // Judge.
  if (body) add_adapted(*body, *found);
  auto run = describe_run(job, *inputs, *found);
  if (!run) return std::unexpected(run.error());
  TrackOutcome outcome;
  outcome.result = std::move(found->result);
  const auto& motion = outcome.result.motion;
  if (auto s = internal::judge(std::move(*run), motion, nullptr, outcome); !s)
    return std::unexpected(s.error());
  // Write.
  nlohmann::ordered_json more;
  if (body) more = {{"adapted", adapted_json(body->result, true)}};
  auto files = internal::motion_files(job, motion, outcome.summary, more);
  if (body) files.push_back(model_file(beside(job.output, internal::kAdaptedModel), body->text));
  internal::add_nwb_file(job, motion, outcome.summary, inputs->recording.trial.beside, files);
  files.push_back(table_file(beside(job.output, "_rank.sto"), [&] { return rank_table(outcome.result); }));
  if (!outcome.result.levels.empty())
    files.push_back(
        table_file(beside(job.output, "_levels.sto"), [&] { return levels_table(outcome.result); }));
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] {
      return internal::motion_page(job, inputs->model, outcome.summary, motion,
                                   found->used ? &*found->used : nullptr, inputs->recording.trial);
    }));
  if (auto s = internal::write(job, *staging, files, "direct marker control", motion, outcome); !s)
    return std::unexpected(s.error());
  if (body) outcome.adapted = std::move(body->result);
  return outcome;
}

}  // namespace kinemark::pipeline
