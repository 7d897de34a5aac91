// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/joints.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/data/filtering.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/articulated/ends.h"
#include "kinemark/stages/skeleton/functional/slip.h"
#include "kinemark/workflow/joints/internal/calibration_part.h"
#include "kinemark/workflow/joints/internal/joints_layout.h"
#include "kinemark/workflow/joints/internal/joints_segmentation.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow {
namespace {

// Parts of a body that were solved each by itself, as one result.

constexpr std::size_t kSegmentsNamed = 8;

std::size_t markers_placed(const data::Skeleton& skeleton) {
  std::size_t n = 0;
  for (const auto& segment : skeleton.segments) n += segment.markers.size();
  return n;
}

/// One joint's centres, states and covariances.
void copy_centres(const data::Skeleton& from, std::size_t joint, data::Skeleton& to, std::size_t to_joint) {
  for (std::int64_t f = 0; f < from.frames(); ++f) {
    const std::size_t i = from.index(f, static_cast<std::int64_t>(joint)),
                      k = to.index(f, static_cast<std::int64_t>(to_joint));
    to.state[k] = from.state[i];
    std::copy_n(from.centre_in_world.data() + 3 * i, 3, to.centre_in_world.data() + 3 * k);
    std::copy_n(from.covariance.data() + 6 * i, 6, to.covariance.data() + 6 * k);
  }
}

/// "segment 'pelvis'", "segments 'pelvis' and 'thigh'", "segments 'a', 'b' and 4 more".
std::string names_of(const data::SegmentLayout& layout) {
  std::vector<std::string> names;
  for (const auto& segment : layout.segments) names.push_back("'" + segment.name + "'");
  return fmt::format("segment{} {}", names.size() == 1 ? "" : "s", join_names(names, kSegmentsNamed));
}

/// Segments and joints of a layout behind those of another.
void append(const data::SegmentLayout& layout, data::SegmentLayout& to) {
  const int first = static_cast<int>(to.segments.size());
  to.segments.insert(to.segments.end(), layout.segments.begin(), layout.segments.end());
  for (const auto& joint : layout.joints)
    to.joints.push_back({joint.name, first + joint.parent, first + joint.child});
}

/// Skeletons of one recording, none of which has a segment of another, one behind the other; one at least.
/// Noise: RMS over all markers placed.
data::Skeleton join_skeletons(std::vector<data::Skeleton> parts) {
  check(!parts.empty(), "one skeleton at least");
  if (parts.size() == 1) return std::move(parts.front());
  data::Skeleton out;
  out.markers = parts.front().markers;
  out.time = parts.front().time;
  double squares = 0.0, markers = 0.0;
  for (const auto& part : parts) {
    const int segment = static_cast<int>(out.segments.size()), joint = static_cast<int>(out.joints.size());
    out.segments.insert(out.segments.end(), part.segments.begin(), part.segments.end());
    for (auto one : part.joints) {
      one.parent_segment += segment;
      one.child_segment += segment;
      out.joints.push_back(std::move(one));
    }
    for (auto length : part.lengths) {
      length.joint_a += joint;
      length.joint_b += joint;
      out.lengths.push_back(std::move(length));
    }
    out.warnings.insert(out.warnings.end(), part.warnings.begin(), part.warnings.end());
    const auto n = static_cast<double>(markers_placed(part));
    squares += n * part.noise_sd_m * part.noise_sd_m;
    markers += n;
  }
  out.noise_sd_m = std::sqrt(squares / std::max(markers, 1.0));
  out.allocate_centres();
  std::size_t to = 0;
  for (const auto& part : parts)
    for (std::size_t j = 0; j < part.joints.size(); ++j, ++to) copy_centres(part, j, out, to);
  return out;
}

/// Screening looks for breaks of paths. Where so large a share of samples breaks them there are no paths: the
/// frames are poses of their own.
constexpr double kMostDefects = 0.05;
// Times what is expected of a body. Noise and distances hardly change from the first geometry to the last;
// reach does.
constexpr double kHopelessNoise = 1.5;
constexpr double kHopelessChange = 1.1;
constexpr double kHopelessReach = 3.0;
constexpr std::size_t kDefectsListed = 5;

/// Only what was really seen, without what screening is sure of, unless the job says otherwise; and a
/// sentence on each.
Status screen_trial(const JointsOptions& options, const data::EditsInForce& edits, data::Trial& trial,
                    JointsFound& outcome) {
  const auto screening = screen_markers(trial, {.find_upsampling = !options.keep_upsampled,
                                                .recorder_made = RecorderMade::missing,
                                                .find_defects = options.drop_doubtful,
                                                .exchange_back = true,
                                                .swapped = edits.swapped,
                                                .reject_defects = true,
                                                .most_rejected = kMostDefects,
                                                .made_first = true});
  if (!screening) return std::unexpected(screening.error());
  auto& warnings = outcome.remarks.warnings;
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
Result<data::Skeleton> estimate(const JointsOptions& options, const data::Trajectories& markers,
                                const data::SegmentLayout& layout, bool& refined, JointsFound& outcome) {
  if (options.method == "articulated") {
    skeleton::ArticulatedOptions fit_options;
    fit_options.noise_sd_m = options.noise_sd_m;
    fit_options.continuity = options.continuity;
    fit_options.soft_tissue = options.soft_tissue;
    fit_options.joint = options.kind;
    fit_options.threads = options.threads;
    if (!refined) {  // beyond what judge_skeleton() takes for a body's the fit need not go on
      constexpr skeleton::PlausibilityOptions body;
      fit_options.most_noise_m = kHopelessNoise * body.most_noise_m;
      fit_options.most_reach_m = kHopelessReach * body.most_length_m;
      fit_options.most_change_m = kHopelessChange * body.most_noise_m;
    }
    auto fit = skeleton::fit_articulated(markers, layout, fit_options, options.progress);
    if (!fit) return std::unexpected(fit.error());
    refined = fit->refined;
    if (!options.soft_tissue) return std::move(fit->skeleton);
    auto& noise = outcome.marker_noise_sd_m;
    noise.resize(fit->marker_noise_sd_m.size(), kNaN);
    for (std::size_t m = 0; m < noise.size(); ++m)
      if (std::isfinite(fit->marker_noise_sd_m[m])) noise[m] = fit->marker_noise_sd_m[m];
    return std::move(fit->skeleton);
  }
  refined = true;
  skeleton::FunctionalOptions find_options;
  find_options.method = skeleton::parse_functional_method(options.method).value();
  find_options.sides = options.sides;
  find_options.kind = options.kind;
  find_options.noise_sd_m = options.noise_sd_m;
  return skeleton::find_joints(markers, layout, find_options);
}

/// A gate for each segment and joint that was left out as no body's, and for each joint that was placed in no
/// frame.
void judge(const JointsOptions& options, JointsFound& outcome) {
  for (const auto& bad : outcome.left_out) {
    const bool short_of = bad.value_m < bad.least_m;
    outcome.remarks.gates.push_back({.name = "plausible",
                                     .passed = false,
                                     .value = 1e3 * bad.value_m,
                                     .bound = 1e3 * (short_of ? bad.least_m : bad.most_m),
                                     .unit = "mm",
                                     .sentence = bad.sentence()});
    outcome.remarks.warnings.push_back("Left out: " + bad.sentence());
  }
  if (!outcome.left_out.empty()) {
    outcome.next_step = propose_next_step(options, outcome);
    outcome.remarks.warnings.push_back(outcome.next_step);
  }
  const auto& skeleton = outcome.skeleton;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    bool placed = false;
    for (std::int64_t f = 0; f < skeleton.frames() && !placed; ++f)
      placed =
          skeleton.state[skeleton.index(f, static_cast<std::int64_t>(j))] != data::CentreState::undetermined;
    if (placed) continue;
    outcome.remarks.gates.push_back(
        {.name = "placed",
         .passed = false,
         .value = 0.0,
         .bound = 1.0,
         .unit = "frames",
         .sentence = fmt::format("Joint '{}' was placed in no frame.", skeleton.joints[j].name)});
    outcome.remarks.warnings.push_back(outcome.remarks.gates.back().sentence);
  }
}

/// What is solved together: all joints, or for the articulated method of segments that were found in the data
/// or are a subject's every tree by itself.
std::vector<data::SegmentLayout> parts_of(const JointsOptions& options, const JointsFound& outcome,
                                          const data::SegmentLayout& layout) {
  const bool as_asked = !outcome.segmentation && outcome.left_out.empty() && !options.of_subject;
  if (options.method != "articulated" || as_asked) return {layout};
  return trees_of(layout);
}

/// Centres and axes of a body: what is none's is left out and the rest is solved anew, until all of it is
/// plausible. A tree of which nothing is left, or that cannot be solved, is reported; it is a failure where
/// no other is.
Status solve_plausibly(const JointsOptions& options, const data::Trajectories& markers,
                       JointsFound& outcome) {
  std::vector<data::SegmentLayout> waiting;
  // Named segments without a joint are refused by the estimator, which says why.
  if (!outcome.segmentation || !outcome.layout.joints.empty())
    waiting = parts_of(options, outcome, outcome.layout);
  std::vector<data::Skeleton> solved;
  Status first;
  outcome.layout = {};
  for (std::size_t next = 0; next < waiting.size(); ++next) {
    data::SegmentLayout layout = std::move(waiting[next]);
    bool refined = false;
    auto found = estimate(options, markers, layout, refined, outcome);
    // What was taken for none of a body's is judged one by the whole recording.
    if (found && !refined && skeleton::judge_skeleton(markers, *found).empty()) {
      refined = true;
      found = estimate(options, markers, layout, refined, outcome);
    }
    if (!found) {
      if (found.error().code != Code::bad_input) return std::unexpected(found.error());
      if (first) first = std::unexpected(with_left_out(outcome, found.error()));
      outcome.remarks.warnings.push_back(fmt::format("{}: {}.", names_of(layout), found.error().message));
      continue;
    }
    const auto bad = skeleton::judge_skeleton(markers, *found);
    if (bad.empty()) {
      solved.push_back(std::move(*found));
      append(layout, outcome.layout);
    } else if (auto s = leave_out(options, bad, layout, outcome); !s) {
      if (first) first = s;
    } else if (!layout.joints.empty()) {
      std::ranges::move(parts_of(options, outcome, layout), std::back_inserter(waiting));
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
Status solve(const JointsOptions& options, const data::Trajectories& markers, JointsFound& outcome) {
  if (auto s = solve_plausibly(options, markers, outcome); !s) return s;
  settle_segmentation(outcome);
  if (outcome.skeleton.joints.empty()) return {};
  auto slips = skeleton::find_slips(markers, outcome.layout);
  if (!slips) return std::unexpected(slips.error());
  outcome.slips = std::move(*slips);
  std::erase_if(outcome.slips,
                [&](const auto& slip) { return skeleton::is_within_repeatability(slip, outcome.skeleton); });
  // The articulated fit itself reports markers that moved on their segment.
  for (const auto& slip : outcome.slips)
    if (options.method != "articulated" || slip.kind == data::FindingKind::joint_slip)
      outcome.remarks.warnings.push_back(sentence_of(slip, markers.time));
  return {};
}

}  // namespace

Status JointsMethod::check() const {
  const bool articulated = method == "articulated";
  if (!articulated && !skeleton::parse_functional_method(method))
    return fail(Code::usage,
                fmt::format("'{}' is not a method; use articulated, score, sara, gamage, gamage-plain, "
                            "cylinder or constant-distance",
                            method));
  if (!(noise_sd_m >= 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage, fmt::format("marker noise of {} mm; need 0 or more", 1e3 * noise_sd_m));
  if (soft_tissue && !articulated)
    return fail(Code::usage,
                fmt::format("soft tissue is a term of the articulated method; '{}' has none", method));
  return {};
}

Result<JointsFound> joints(const data::Recording& recording, const JointsOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  data::Trial trial;
  trial.markers = recording.trial.markers;
  trial.first_frame = recording.trial.first_frame;
  JointsFound found;
  found.markers = trial.markers.names;
  if (auto note = data::note_on_noise(trial.markers); !note.empty() && options.noise_sd_m == 0.0)
    found.remarks.warnings.push_back(std::move(note));
  if (auto s = screen_trial(options, recording.edits, trial, found); !s) return std::unexpected(s.error());
  if (auto note = bring_to_one_time(trial.markers); !note.empty())
    found.remarks.warnings.push_back(std::move(note));
  found.used = std::move(trial.markers);
  if (auto s = lay_out(options, found.used, found); !s) return std::unexpected(s.error());
  if (auto s = solve(options, found.used, found); !s) return std::unexpected(s.error());
  if (options.segments && !found.skeleton.joints.empty()) {
    found.layout.ends = options.segments->ends;
    skeleton::place_ends(found.used, found.layout.ends, found.skeleton);
    std::erase_if(found.layout.ends, [&](const auto& end) {
      return std::ranges::find(found.skeleton.ends, end.name, &data::SkeletonEnd::name) ==
             found.skeleton.ends.end();
    });
  }
  if (auto note =
          data::note_held("Deviations of centres and lengths",
                          internal::add_calibration_error(recording.trial.calibration_error, found.skeleton));
      !note.empty())
    found.remarks.warnings.push_back(std::move(note));
  judge(options, found);
  add_contradictions(recording.contradicted, found.remarks.gates);
  return found;
}

data::Trajectories centre_trajectories(const data::Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const auto& joint : skeleton.joints) names.push_back(joint.name);
  for (const auto& end : skeleton.ends) names.push_back(end.name);
  const auto J = static_cast<std::int64_t>(skeleton.joints.size());
  auto out = data::Trajectories::all_missing(std::move(names), skeleton.time);
  out.covariance.assign(6 * out.state.size(), kNaN);
  const auto put = [&](std::int64_t f, std::int64_t m, data::CentreState state, const double* x,
                       const double* C, const std::string& method) {
    const std::size_t i = out.index(f, m);
    std::copy_n(C, 6, out.covariance.data() + 6 * i);
    if (state == data::CentreState::undetermined) return;
    std::copy_n(x, 3, out.x_in_world.data() + 3 * i);
    out.state[i] = state == data::CentreState::bridged ? data::SampleState::interpolated
                                                       : data::SampleState::model_filled;
    out.set_method(f, m, fmt::format("{}: {}", method, data::to_string(state)));
  };
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    for (std::int64_t j = 0; j < J; ++j) {
      const std::size_t i = skeleton.index(f, j);
      put(f, j, skeleton.state[i], skeleton.centre_in_world.data() + 3 * i,
          skeleton.covariance.data() + 6 * i, skeleton.joints[static_cast<std::size_t>(j)].method);
    }
    for (std::size_t e = 0; e < skeleton.ends.size(); ++e) {
      const auto& end = skeleton.ends[e];
      put(f, J + static_cast<std::int64_t>(e), end.state[static_cast<std::size_t>(f)],
          end.centre_in_world.data() + 3 * f, end.covariance_in_world.data() + 6 * f,
          end.stays() ? "stays in the room" : "end");
    }
  }
  return out;
}

}  // namespace kinemark::workflow
