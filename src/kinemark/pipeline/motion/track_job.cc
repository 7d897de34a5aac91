// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/track_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/core/text.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/workflow/motion/track.h"

namespace kinemark::pipeline {
namespace {

std::string list(const std::vector<std::string>& names) { return names.empty() ? "none" : join(names); }

std::vector<std::pair<std::string, std::string>> describe_options(const TrackJob& job,
                                                                  const motion::TrackResult& result) {
  const auto& o = job.options;
  std::vector<std::pair<std::string, std::string>> options{
      {"levels of priority", std::to_string(std::max<std::size_t>(1, o.levels.size()))}};
  for (std::size_t i = 0; i < o.levels.size(); ++i)
    options.emplace_back(fmt::format("level {}", i + 1), list(o.levels[i].markers));
  options.emplace_back("gains", o.kp > 0.0 ? fmt::format("kp {:g} 1/s^2, kd {:g} 1/s", o.kp, o.kd)
                                           : fmt::format("omega {:g} rad/s", o.omega_rad_s));
  options.emplace_back("step", fmt::format("{:.4g} ms", 1e3 * result.step_s));
  options.emplace_back("damping", fmt::format("{:g}", o.damping));
  options.emplace_back("cut-off of the goals",
                       o.cutoff_hz > 0.0 ? fmt::format("{:g} Hz", o.cutoff_hz) : "none");
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

Result<Staging> stage_files(const TrackJob& job) {
  std::vector<std::string> files{"_tau.sto", "_rank.sto", "_marker_errors.sto"};
  if (job.options.error_bars) files.insert(files.end(), {"_sd.sto", "_bound.sto", "_tau_sd.sto"});
  files.push_back("_report.json");
  std::vector<std::filesystem::path> further;
  if (!job.report.empty()) further.push_back(job.report);
  return internal::stage(job, files, further);
}

}  // namespace

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
  const auto inputs = internal::read_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  // Solve.
  auto found = workflow::track(
      inputs->model, inputs->recording,
      {.track = job.options, .bounds = job, .images = inputs->image_tracks(), .progress = job.progress});
  if (!found) {
    if (found.error().code == Code::usage) return std::unexpected(found.error());
    return fail_at(job.markers.string(), found.error());
  }
  // Judge.
  auto run = describe_run(job, *inputs, *found);
  if (!run) return std::unexpected(run.error());
  TrackOutcome outcome;
  outcome.result = std::move(found->result);
  const auto& motion = outcome.result.motion;
  if (auto s = internal::judge(std::move(*run), motion, nullptr, outcome); !s)
    return std::unexpected(s.error());
  // Write.
  auto files = internal::motion_files(job, motion, outcome.summary);
  internal::add_nwb_file(job, motion, outcome.summary, inputs->recording.trial.beside, files);
  files.push_back(table_file(beside(job.output, "_rank.sto"), [&] { return rank_table(outcome.result); }));
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] {
      return internal::motion_page(job, inputs->model, outcome.summary, motion,
                                   found->used ? &*found->used : nullptr, inputs->recording.trial);
    }));
  if (auto s = internal::write(job, *staging, files, "direct marker control", motion, outcome); !s)
    return std::unexpected(s.error());
  return outcome;
}

}  // namespace kinemark::pipeline
