// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/data/filtering.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/marker_screening.h"
#include "kinemark/pipeline/files/page_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/files/screen_axes.h"
#include "kinemark/pipeline/joints/joints_json.h"
#include "kinemark/pipeline/joints/joints_layout.h"
#include "kinemark/pipeline/joints/joints_page.h"
#include "kinemark/pipeline/joints/joints_parts.h"
#include "kinemark/pipeline/joints/joints_segmentation.h"
#include "kinemark/pipeline/joints/segments_file.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// Screening looks for breaks of paths. Where so large a share of samples breaks them there are no paths: the
/// frames are poses of their own.
constexpr double kMostDefects = 0.05;
// Times what is expected of a body. Noise and distances hardly change from the first geometry to the last;
// reach does.
constexpr double kHopelessNoise = 1.5;
constexpr double kHopelessChange = 1.1;
constexpr double kHopelessReach = 3.0;
constexpr std::size_t kDefectsListed = 5;

bool into_folder(const fs::path& output) { return !output.has_extension() || fs::is_directory(output); }

Status check_options(const JointsJob& job) {
  const bool articulated = job.method == "articulated";
  if (!articulated && !skeleton::parse_functional_method(job.method))
    return fail(Code::usage,
                fmt::format("'{}' is not a method; use articulated, score, sara, gamage, gamage-plain, "
                            "cylinder or constant-distance",
                            job.method));
  if (!(job.noise_sd_m >= 0.0) || !std::isfinite(job.noise_sd_m))
    return fail(Code::usage, fmt::format("marker noise of {} mm; need 0 or more", 1e3 * job.noise_sd_m));
  if (job.soft_tissue && !articulated)
    return fail(Code::usage,
                fmt::format("soft tissue is a term of the articulated method; '{}' has none", job.method));
  if (!job.output.empty() && !into_folder(job.output)) return io::check_marker_format(job.output);
  return {};
}

/// Only what was really seen, without what screening is sure of, unless the job says otherwise; and a
/// sentence on each.
Status screen_trial(const JointsJob& job, const EditsTaken& edits, data::Trial& trial,
                    JointsOutcome& outcome) {
  const auto screening = screen_markers(trial, {.find_upsampling = !job.keep_upsampled,
                                                .recorder_made = RecorderMade::missing,
                                                .find_defects = job.drops_doubtful(true),
                                                .exchange_back = true,
                                                .swapped = edits.swapped,
                                                .reject_defects = true,
                                                .most_rejected = kMostDefects,
                                                .made_first = true});
  if (!screening) return std::unexpected(screening.error());
  auto& warnings = outcome.warnings;
  if (screening->made_left_out > 0)
    warnings.push_back(
        fmt::format("{} samples that the recorder interpolated were left out.", screening->made_left_out));
  std::ranges::move(swap_sentences(*screening, trial.markers.time), std::back_inserter(warnings));
  const auto& sure = screening->sure;
  if (sure.empty()) return {};
  if (!screening->rejected) {
    warnings.push_back(
        fmt::format("{:.0f} % of the samples break their paths: frames are taken as poses of their own, and "
                    "nothing was rejected.",
                    100.0 * screening->sure_share));
    return {};
  }
  for (std::size_t i = 0; i < sure.size() && i < kDefectsListed; ++i)
    warnings.push_back("Left out: " + sentence_of(sure[i], trial.markers.time));
  if (sure.size() > kDefectsListed)
    warnings.push_back(fmt::format("Left out: {} more defects like these.", sure.size() - kDefectsListed));
  return {};
}

/// `refined`: even what is none of a body's. Else its first geometry may be returned as it is; `refined` then
/// becomes false.
Result<data::Skeleton> estimate(const JointsJob& job, const data::Trajectories& markers,
                                const data::SegmentLayout& layout, bool& refined, JointsOutcome& outcome) {
  if (job.method == "articulated") {
    skeleton::ArticulatedOptions options;
    options.noise_sd_m = job.noise_sd_m;
    options.continuity = job.continuity;
    options.soft_tissue = job.soft_tissue;
    options.joint = job.kind;
    options.threads = job.threads;
    if (!refined) {  // beyond what judge_skeleton() takes for a body's the fit need not go on
      constexpr skeleton::PlausibilityOptions body;
      options.most_noise_m = kHopelessNoise * body.most_noise_m;
      options.most_reach_m = kHopelessReach * body.most_length_m;
      options.most_change_m = kHopelessChange * body.most_noise_m;
    }
    auto fit = skeleton::fit_articulated(markers, layout, options, job.progress);
    if (!fit) return std::unexpected(fit.error());
    refined = fit->refined;
    if (!job.soft_tissue) return std::move(fit->skeleton);
    auto& noise = outcome.marker_noise_sd_m;
    noise.resize(fit->marker_noise_sd_m.size(), kNaN);
    for (std::size_t m = 0; m < noise.size(); ++m)
      if (std::isfinite(fit->marker_noise_sd_m[m])) noise[m] = fit->marker_noise_sd_m[m];
    return std::move(fit->skeleton);
  }
  refined = true;
  skeleton::FunctionalOptions options;
  options.method = skeleton::parse_functional_method(job.method).value();
  options.sides = job.sides;
  options.kind = job.kind;
  options.noise_sd_m = job.noise_sd_m;
  return skeleton::find_joints(markers, layout, options);
}

/// A gate for each segment and joint that was left out as no body's, and for each joint that was placed in no
/// frame.
void judge(const JointsJob& job, JointsOutcome& outcome) {
  for (const auto& bad : outcome.left_out) {
    const bool short_of = bad.value_m < bad.least_m;
    outcome.gates.push_back({.name = "plausible",
                             .passed = false,
                             .value = 1e3 * bad.value_m,
                             .bound = 1e3 * (short_of ? bad.least_m : bad.most_m),
                             .unit = "mm",
                             .sentence = bad.sentence()});
    outcome.warnings.push_back("Left out: " + bad.sentence());
  }
  if (!outcome.left_out.empty()) {
    outcome.next_step = propose_next_step(job, outcome);
    outcome.warnings.push_back(outcome.next_step);
  }
  const auto& skeleton = outcome.skeleton;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    bool placed = false;
    for (std::int64_t f = 0; f < skeleton.frames() && !placed; ++f)
      placed =
          skeleton.state[skeleton.index(f, static_cast<std::int64_t>(j))] != data::CentreState::undetermined;
    if (placed) continue;
    outcome.gates.push_back(
        {.name = "placed",
         .passed = false,
         .value = 0.0,
         .bound = 1.0,
         .unit = "frames",
         .sentence = fmt::format("Joint '{}' was placed in no frame.", skeleton.joints[j].name)});
    outcome.warnings.push_back(outcome.gates.back().sentence);
  }
}

/// What is solved together: all joints, or for the articulated method of segments that were found in the data
/// or are a subject's every tree by itself.
std::vector<data::SegmentLayout> parts_of(const JointsJob& job, const JointsOutcome& outcome,
                                          const data::SegmentLayout& layout) {
  const bool as_asked = !outcome.segmentation && outcome.left_out.empty() && !is_subject(job);
  if (job.method != "articulated" || as_asked) return {layout};
  return trees_of(layout);
}

/// Centres and axes of a body: what is none's is left out and the rest is solved anew, until all of it is
/// plausible. A tree of which nothing is left, or that cannot be solved, is reported; it is a failure where
/// no other is.
Status solve_plausibly(const JointsJob& job, const data::Trajectories& markers, JointsOutcome& outcome) {
  std::vector<data::SegmentLayout> waiting;
  // Named segments without a joint are refused by the estimator, which says why.
  if (!outcome.segmentation || !outcome.layout.joints.empty())
    waiting = parts_of(job, outcome, outcome.layout);
  std::vector<data::Skeleton> solved;
  Status first;
  outcome.layout = {};
  for (std::size_t next = 0; next < waiting.size(); ++next) {
    data::SegmentLayout layout = std::move(waiting[next]);
    bool refined = false;
    auto found = estimate(job, markers, layout, refined, outcome);
    // What was taken for none of a body's is judged one by the whole recording.
    if (found && !refined && skeleton::judge_skeleton(markers, *found).empty()) {
      refined = true;
      found = estimate(job, markers, layout, refined, outcome);
    }
    if (!found) {
      if (found.error().code != Code::bad_input) return std::unexpected(found.error());
      if (first) first = std::unexpected(with_left_out(outcome, found.error()));
      outcome.warnings.push_back(
          fmt::format("Nothing can be said of {}: {}.", names_of(layout), found.error().message));
      continue;
    }
    const auto bad = skeleton::judge_skeleton(markers, *found);
    if (bad.empty()) {
      solved.push_back(std::move(*found));
      append(layout, outcome.layout);
    } else if (auto s = leave_out(job, bad, layout, outcome); !s) {
      if (first) first = s;
    } else if (!layout.joints.empty()) {
      std::ranges::move(parts_of(job, outcome, layout), std::back_inserter(waiting));
    }
  }
  if (solved.empty() && outcome.segmentation) {
    outcome.skeleton.markers = markers.names;
    outcome.skeleton.time = markers.time;
    outcome.skeleton.noise_sd_m = kNaN;
    return {};
  }
  if (solved.empty()) return first;
  outcome.skeleton = join_skeletons(std::move(solved));
  return {};
}

/// Centres and axes, and markers that moved on their segment.
Status solve(const JointsJob& job, const data::Trajectories& markers, JointsOutcome& outcome) {
  if (auto s = solve_plausibly(job, markers, outcome); !s) return s;
  settle_segmentation(outcome);
  if (outcome.skeleton.joints.empty()) return {};
  auto slips = skeleton::find_slips(markers, outcome.layout);
  if (!slips) return std::unexpected(slips.error());
  outcome.slips = std::move(*slips);
  std::erase_if(outcome.slips,
                [&](const auto& slip) { return skeleton::is_within_repeatability(slip, outcome.skeleton); });
  // The articulated fit itself reports markers that moved on their segment.
  for (const auto& slip : outcome.slips)
    if (job.method != "articulated" || slip.kind == data::FindingKind::joint_slip)
      outcome.warnings.push_back(sentence_of(slip, markers.time));
  return {};
}

Result<Staging> stage(const JointsJob& job) {
  const auto& output = job.output;
  if (output.empty()) return Staging::create({}, job, {});
  auto inputs = files_of(job.input, job);
  inputs.push_back(job.segments);
  if (!into_folder(output)) return Staging::create({output, beside(output, "_skeleton.json")}, job, inputs);
  return Staging::create_in(output, {"centres.csv", "skeleton.json", "centres.c3d", "segments.toml"}, job,
                            inputs);
}

std::vector<ResultFile> list_files(const JointsJob& job, const JointsOutcome& outcome,
                                   const data::Trial& centres, const std::vector<fs::path>& targets) {
  std::vector<ResultFile> files;
  for (const auto& target : targets) {
    if (outcome.skeleton.joints.empty() && target.extension() != ".json") continue;
    files.push_back(target.extension() == ".json"
                        ? json_file(target, [&] { return joints_json(job, outcome); })
                    : target.extension() == ".toml"
                        ? toml_file(target, [&] { return segments_text(outcome.layout, outcome.markers); })
                        : marker_file(target, centres));
  }
  return files;
}

std::string name_set(const JointsJob& job, const JointsOutcome& outcome, const data::Trial& centres) {
  SetDigest digest;
  digest.add("joints").add(std::vector{outcome.input}).add(job.method).add(centres.markers);
  return digest.add(std::span<const double>(centres.markers.covariance))
      .add(segments_text(outcome.layout, outcome.markers))
      .hex();
}

}  // namespace

Result<JointsOutcome> run_joints(const JointsJob& job) {
  // Prepare: markers, without what is not to be trusted; segments; where results go.
  if (auto s = check_options(job); !s) return std::unexpected(s.error());
  auto recording = open_recording({.path = job.input,
                                   .needs_samples = true,
                                   .record = true,
                                   .force = job.force,
                                   .seed = job.seed,
                                   .threads = job.threads},
                                  job);
  if (!recording) return std::unexpected(recording.error());
  auto& trial = recording->trial;
  JointsOutcome outcome;
  outcome.input = std::move(recording->file);
  outcome.markers = trial.markers.names;
  outcome.warnings = std::move(recording->notes);
  if (auto note = data::note_on_noise(trial.markers); !note.empty() && job.noise_sd_m == 0.0)
    outcome.warnings.push_back(std::move(note));
  const std::string name = job.input.string();
  if (auto s = screen_trial(job, recording->edits, trial, outcome); !s) return fail_at(name, s.error());
  if (auto s = lay_out(job, trial.markers, outcome); !s) return std::unexpected(s.error());
  auto staging = stage(job);
  if (!staging) return std::unexpected(staging.error());
  staging->add_inputs(std::vector{outcome.input});
  auto others = staging->targets();
  std::ranges::copy(files_of(job.input, job), std::back_inserter(others));
  others.push_back(job.segments);
  auto page = PageFile::begin(job.report, job, others);
  if (!page) return std::unexpected(page.error());
  // Solve and judge.
  if (auto s = solve(job, trial.markers, outcome); !s) return fail_at(name, s.error());
  judge(job, outcome);
  // Write.
  data::Trial centres;
  centres.source = trial.source;
  centres.first_frame = trial.first_frame;
  centres.markers = centre_trajectories(outcome.skeleton);
  if (const auto up = stated_vertical(job.axes)) set_screen_up(centres, up->up);
  auto written = write_results(*staging, list_files(job, outcome, centres, staging->targets()), {},
                               "the search for joints", name_set(job, outcome, centres));
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  if (page->wanted())
    if (auto s = page->write(joints_page(job, outcome, trial), outcome); !s)
      return std::unexpected(s.error());
  return outcome;
}

data::Trajectories centre_trajectories(const data::Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const auto& joint : skeleton.joints) names.push_back(joint.name);
  auto out = data::Trajectories::all_missing(std::move(names), skeleton.time);
  out.covariance = skeleton.covariance;
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::int64_t j = 0; j < out.markers(); ++j) {
      const auto state = skeleton.state[skeleton.index(f, j)];
      if (state == data::CentreState::undetermined) continue;
      out.x(f, j) = skeleton.centre(f, j);
      out.state[out.index(f, j)] = state == data::CentreState::bridged ? data::SampleState::interpolated
                                                                       : data::SampleState::model_filled;
      out.set_method(
          f, j,
          fmt::format("{}: {}", skeleton.joints[static_cast<std::size_t>(j)].method, data::to_string(state)));
    }
  return out;
}

}  // namespace kinemark::pipeline
