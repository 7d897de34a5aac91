// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/loose_bodies.h"
#include "kinemark/stages/motion/internal/marker_account.h"
#include "kinemark/stages/motion/internal/rival_poses.h"
#include "kinemark/stages/motion/internal/solved_motion.h"
#include "kinemark/stages/motion/orientation/internal/marker_mounts.h"
#include "kinemark/stages/motion/orientation/internal/mixed_bars.h"
#include "kinemark/stages/motion/orientation/internal/placed_sensors.h"
#include "kinemark/stages/motion/orientation/internal/sensor_errors.h"
#include "kinemark/stages/motion/orientation/internal/sensor_samples.h"
#include "kinemark/stages/motion/orientation/orientation_ik.h"

namespace kinemark::motion {
namespace {

using internal::Heading;
using internal::MarkerMounts;
using internal::PosedSensors;
using internal::Problem;
using internal::TurnedBodies;

constexpr double kNominalSensor = 0.02;     // rad, where neither given nor in the residuals
constexpr double kNominalMarker = 2e-3;     // m, likewise
constexpr double kExactMarker = 1e-5;       // m: what alone remains of residuals is rounding, or nothing
constexpr double kLeastMarker = 5e-5;       // m
constexpr std::int64_t kMountFrames = 300;  // at most, that place sensors
constexpr int kPasses = 2;                  // the noise of the first one weighs the second

/// What the markers alone gave: the model with those used, their samples as they were kept, the states.
struct Alone {
  model::Model model;
  data::Trajectories markers;
  Eigen::MatrixXd states;
  IkOptions options;  ///< for the same markers again
};

Result<Alone> take_apart(const model::Model& model, const IkResult& solved, const IkOptions& given) {
  Alone out;
  const auto& motion = solved.motion;
  data::ModelDescription used = model.description();
  used.markers.clear();
  for (const auto& name : motion.markers)
    used.markers.push_back(model.description().markers[at(model.description().find_marker(name))]);
  auto compiled = model::Model::compile(std::move(used), {.free_roots = !model.free_joints().empty()});
  if (!compiled) return std::unexpected(compiled.error());
  out.model = std::move(*compiled);
  out.options = given;
  out.options.loss = Loss::square;
  out.options.judge_samples = false;
  out.options.first_time_s = -1e300;
  out.options.last_time_s = 1e300;
  out.options.marker_weights.clear();
  for (const auto& marker : solved.fit.markers)
    out.options.marker_weights.push_back({.marker = marker.name, .weight = marker.weight});
  const auto M = std::ssize(motion.markers);
  out.markers = data::Trajectories::all_missing(motion.markers, motion.time);
  out.states.resize(out.model.state_count(), motion.frames());
  model::Workspace w(out.model);
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    out.states.col(f) = model::state_from_coordinates(
        out.model, Eigen::Map<const Eigen::VectorXd>(motion.q.data() + motion.index(f, 0), motion.size()));
    model::kinematics(out.model, w, out.states.col(f));
    for (std::int64_t m = 0; m < M; ++m) {
      const Eigen::Map<const Eigen::Vector3d> error(motion.marker_error.data() + 3 * (f * M + m));
      if (!error.allFinite()) continue;
      out.markers.x(f, m) = w.marker.col(m) + error;
      out.markers.state[out.markers.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

/// Variances of the markers' errors as solve_ik() found them; the mean one of a marker of weight 1.
MarkerVariances variances_of(const model::Model& model, const data::MarkerFit& fit) {
  MarkerVariances out;
  out.own.setZero(model.marker_count());
  out.common.setZero(std::ssize(model.bodies()));
  for (int m = 0; m < model.marker_count(); ++m) {
    const auto& marker = fit.markers[at(m)];
    if (std::isfinite(marker.noise_sd_m)) out.own[m] = marker.noise_sd_m * marker.noise_sd_m;
    const int body = model.markers()[at(m)].body;
    if (body >= 0 && std::isfinite(marker.common_sd_m))
      out.common[body] = marker.common_sd_m * marker.common_sd_m;
  }
  return out;
}

double mean_variance(const model::Model& model, const data::MarkerFit& fit,
                     const MarkerVariances& variances) {
  double sum = 0.0, seen = 0.0;
  for (int m = 0; m < model.marker_count(); ++m) {
    const int body = model.markers()[at(m)].body;
    const auto& marker = fit.markers[at(m)];
    sum += marker.weight * marker.seen * (variances.own[m] + (body >= 0 ? variances.common[body] : 0.0));
    seen += marker.seen;
  }
  return seen > 0.0 ? sum / seen : 0.0;
}

std::vector<std::int64_t> spread_frames(std::int64_t frames) {
  std::vector<std::int64_t> out;
  const std::int64_t stride = (frames + kMountFrames - 1) / kMountFrames;
  for (std::int64_t f = 0; f < frames; f += std::max<std::int64_t>(1, stride)) out.push_back(f);
  return out;
}

/// Sensors on the frames of the markers, on their bodies and as far as a pose or the model place them.
Result<PosedSensors> match_sensors(const model::Model& model, const data::Orientations& recording,
                                   const data::Orientations& on_frames, const data::Orientations* pose,
                                   const OrientationOptions& options, std::vector<std::string>& never_seen) {
  auto posed = pose == nullptr ? internal::sensors_on_bodies(model, on_frames, options)
                               : internal::pose_sensors(model, on_frames, pose, options);
  if (!posed) return posed;
  if (std::ranges::all_of(on_frames.quaternion, [](double q) { return std::isnan(q); }))
    return fail(
        Code::bad_input,
        fmt::format("orientations from {:g} to {:g} s and markers from {:g} to {:g} s have no time in common",
                    recording.time.t0_s,
                    recording.time.time_s(std::max<std::int64_t>(0, recording.frames() - 1)),
                    on_frames.time.t0_s, on_frames.time.time_s(on_frames.frames() - 1)));
  std::vector<std::int64_t> all(at(on_frames.frames()));
  std::iota(all.begin(), all.end(), std::int64_t{0});
  if (auto s = internal::drop_unseen(on_frames, all, *posed, never_seen); !s)
    return std::unexpected(s.error());
  return posed;
}

/// Given, or by markers, or by the motion of the sensors alone where markers say nothing.
Result<Heading> find_heading(const model::Model& model, const data::Orientations& sensors,
                             const PosedSensors& posed, const MarkerMounts& mounts,
                             const OrientationOptions& options, HeadingSource& source) {
  if (options.facing) {
    source = HeadingSource::facing;
    if (posed.unplaced || posed.by_model)
      return fail(Code::bad_input, "an axis that faces forward gives the heading in a pose; there is none");
    const auto given = internal::heading_of(posed, sensors, *options.facing);
    if (!given) return std::unexpected(given.error());
    return Heading{.rad = *given};
  }
  source = HeadingSource::markers;
  auto found = mounts.find_heading();
  if (found || posed.unplaced || posed.by_model) return found;
  source = HeadingSource::motion;
  std::vector<std::int64_t> all(at(sensors.frames()));
  std::iota(all.begin(), all.end(), std::int64_t{0});
  return internal::estimate_heading(model, sensors, posed, all, options);
}

/// Where the bodies of the sensors are in given states, F x S, m.
std::vector<Eigen::Vector3d> origins_of(const model::Model& model, const std::vector<int>& bodies,
                                        const Eigen::MatrixXd& states) {
  model::Workspace w(model);
  std::vector<Eigen::Vector3d> out;
  for (Eigen::Index f = 0; f < states.cols(); ++f) {
    model::kinematics(model, w, states.col(f));
    for (const int body : bodies) out.push_back(w.position[at(body)]);
  }
  return out;
}

/// Markers and far points, solved.
struct Together {
  Problem problem;
  data::Trajectories points;
  internal::SolvedFrames solved;
  MarkerVariances variances;
  std::vector<internal::RivalPose> rivals;
};

/// One pass with the noise as `turned` has it.
Status solve_pass(const Alone& alone, const TurnedBodies& turned, const MarkerVariances& of_markers,
                  const Eigen::MatrixXd& states, const Progress& progress, Together& out) {
  out.points =
      internal::add_far_points(alone.markers, turned.turned, origins_of(alone.model, turned.body, states));
  std::vector<int> bodies;
  for (const int body : turned.body) bodies.push_back(alone.model.bodies()[at(body)].description_idx);
  auto model = model::Model::compile(internal::add_far_points(alone.model.description(), bodies),
                                     {.free_roots = !alone.model.free_joints().empty()});
  if (!model) return std::unexpected(model.error());
  IkOptions options = alone.options;
  const double weight = internal::far_weight(turned.marker_variance, turned.noise_variance);
  for (auto m = alone.markers.names.size(); m < out.points.names.size(); ++m)
    options.marker_weights.push_back({.marker = out.points.names[m], .weight = weight});
  auto problem = internal::make_problem(*model, out.points, options);
  if (!problem) return std::unexpected(problem.error());
  out.problem = std::move(*problem);
  const auto M = of_markers.own.size(), all = std::ssize(out.points.names);
  out.variances.common = of_markers.common;
  out.variances.own.setConstant(all, 2.0 * internal::kFar_m * internal::kFar_m * turned.noise_variance);
  out.variances.own.head(M) = of_markers.own;
  internal::FrameWalk walk(out.problem, options, progress);
  out.solved = {};
  if (!walk.run(out.points, false, out.solved))
    return fail(Code::cancelled, "inverse kinematics was stopped");
  const auto loose = internal::find_loose_frames(out.problem, out.points);
  out.rivals.clear();
  if (loose.any()) {
    std::vector<std::uint8_t> changed;
    out.rivals = internal::choose_among_rivals(out.problem, options, out.points, loose, out.variances, walk,
                                               out.solved, changed);
  }
  out.solved.iterations = walk.iterations();
  return {};
}

/// Poses, errors and status of the passes into the motion that the markers alone had.
void take_together(Together& together, std::size_t sensors, IkResult& result) {
  auto& motion = result.motion;
  internal::fill_coordinates(together.problem, together.solved.states, motion);
  const std::size_t M = motion.markers.size(), all = M + sensors * internal::kCorners;
  result.cost = 0.0;
  for (std::size_t f = 0; f < at(motion.frames()); ++f) {
    const double* from = together.solved.marker_error.data() + 3 * f * all;
    std::copy_n(from, 3 * M, motion.marker_error.data() + 3 * f * M);
    double squares = 0.0, weight = 0.0;
    for (std::size_t m = 0; m < M; ++m) {
      if (std::isnan(from[3 * m])) continue;
      const double w = together.problem.weight[static_cast<Eigen::Index>(m)];
      squares += w * Eigen::Map<const Eigen::Vector3d>(from + 3 * m).squaredNorm();
      weight += w;
    }
    if (weight > 0.0) result.cost += squares / weight;
  }
  motion.status = together.solved.status;
  result.iterations = together.solved.iterations;
  result.fit.max_loop_gap_m = 0.0;
  for (const double gap : together.solved.loop_gap_m)
    result.fit.max_loop_gap_m = std::max(result.fit.max_loop_gap_m, gap);
  std::erase_if(result.fit.findings,
                [](const auto& finding) { return finding.kind == data::FindingKind::at_limit; });
  internal::note_limits(together.problem, motion, result.fit);
  internal::add_marker_errors(motion, result.fit);
}

/// F x S angles between bodies and what their sensors say.
Array<double> errors_of(const Problem& problem, const Eigen::MatrixXd& states, const TurnedBodies& turned) {
  Array<double> out(turned.turned.size(), kNaN);
  model::Workspace w(problem.model);
  for (std::size_t f = 0; f < at(states.cols()); ++f) {
    model::kinematics(problem.model, w, states.col(static_cast<Eigen::Index>(f)));
    for (std::size_t s = 0; s < turned.size(); ++s)
      if (turned.present(f, s))
        out[f * turned.size() + s] =
            Eigen::AngleAxisd(Eigen::Matrix3d(w.rotation[at(turned.body[s])].transpose() *
                                              turned.turned[f * turned.size() + s]))
                .angle();
  }
  return out;
}

void add_bars(const Together& together, const TurnedBodies& turned, bool noise_is_known, int threads,
              IkResult& result) {
  auto& motion = result.motion;
  internal::compute_mixed_bars(together.problem, together.points, together.solved.states, together.variances,
                               turned, threads, motion);
  internal::doubt_rivals(together.problem, together.rivals, motion);
  internal::flag_underdetermined(motion);
  if (!noise_is_known) std::ranges::fill(motion.q_sd, kNaN);
}

}  // namespace

Result<MixedResult> solve_mixed(const model::Model& model, const data::Trajectories& markers,
                                const data::Orientations& recording, const data::Orientations* pose,
                                const IkOptions& ik, const OrientationOptions& options,
                                const Progress& progress) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = recording.validate(); !s) return std::unexpected(s.error());
  if (pose != nullptr)
    if (auto s = pose->validate(); !s) return std::unexpected(s.error());
  if (options.judge_samples) {
    const auto judged = internal::judge_sensors(recording, pose);
    auto as_given = options;
    as_given.judge_samples = false;
    auto found = solve_mixed(model, markers, judged.recording, judged.pose_or_null(), ik, as_given, progress);
    if (found) judged.account(found->ik.motion.time, found->fit);
    return found;
  }
  const auto start = std::chrono::steady_clock::now();
  MixedResult out;
  IkOptions with_bars = ik;
  with_bars.error_bars = true;  // of which the noise of the markers follows
  with_bars.loss = Loss::square;
  auto solved = solve_ik(model, markers, with_bars, progress);
  if (!solved) return std::unexpected(solved.error());
  out.ik = std::move(*solved);
  const auto alone = take_apart(model, out.ik, ik);
  if (!alone) return std::unexpected(alone.error());

  const auto sensors = internal::at_times(recording, out.ik.motion.time);
  auto& fit = out.fit;
  const auto posed = match_sensors(model, recording, sensors, pose, options, fit.never_seen);
  if (!posed) return std::unexpected(posed.error());
  fit.first_frame = out.ik.fit.first_frame;
  fit.left_out = posed->left_out;
  fit.pose_drift_rad = posed->drift_rad;
  const auto plain = internal::make_problem(alone->model, alone->markers, alone->options);
  if (!plain) return std::unexpected(plain.error());
  auto of_markers = variances_of(alone->model, out.ik.fit);
  double marker_variance = mean_variance(alone->model, out.ik.fit, of_markers);
  const bool markers_known = marker_variance > kExactMarker * kExactMarker;
  if (!markers_known) {
    marker_variance = kNominalMarker * kNominalMarker;
    of_markers.own.setConstant(marker_variance);
    of_markers.common.setZero();
  }
  const auto frames = spread_frames(out.ik.motion.frames());
  const MarkerMounts mounts(
      *posed, sensors,
      internal::find_marked_turns(*plain, alone->markers, alone->states,
                                  information_of(alone->model, of_markers), *posed, frames),
      frames);
  const auto heading = find_heading(model, sensors, *posed, mounts, options, fit.heading_source);
  if (!heading) return std::unexpected(heading.error());
  fit.heading_rad = heading->rad;
  fit.heading_sd_rad = heading->sd_rad;
  auto turned = internal::turn_bodies(alone->model, sensors, *posed, mounts, *heading, fit);
  if (turned.size() == 0)
    return fail(
        Code::bad_input,
        "markers determine no body that carries a sensor, and no pose says how sensors stand on them; "
        "give one, --calibration");

  const bool sensors_given = options.noise_sd_rad > 0.0;
  turned.marker_variance = marker_variance;
  turned.noise_variance =
      sensors_given ? options.noise_sd_rad * options.noise_sd_rad : kNominalSensor * kNominalSensor;
  Together together;
  bool sensors_known = sensors_given;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Eigen::MatrixXd states = pass == 0 ? alone->states : together.solved.states;
    if (auto s = solve_pass(*alone, turned, of_markers, states, progress, together); !s)
      return std::unexpected(s.error());
    const auto noise =
        internal::estimate_mixed_noise(together.problem, together.points, together.solved.states, turned);
    if (!sensors_given && noise.sensor_variance > 0.0) {
      turned.noise_variance = noise.sensor_variance;
      sensors_known = true;
    }
    if (!markers_known && noise.marker_variance > 0.0) {
      turned.marker_variance = std::max(noise.marker_variance, kLeastMarker * kLeastMarker);
      of_markers.own.setConstant(turned.marker_variance);
    }
  }
  fit.noise_sd_rad = sensors_known ? std::sqrt(turned.noise_variance) : kNaN;
  take_together(together, turned.size(), out.ik);
  out.error_rad = errors_of(together.problem, together.solved.states, turned);
  internal::summarize_errors(out.error_rad, fit);
  out.ik.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (ik.error_bars) {
    add_bars(together, turned, sensors_known, ik.threads, out.ik);
  } else {
    out.ik.motion.q_sd.clear();
    out.ik.motion.determined.clear();
    out.ik.motion.open_frames.clear();
  }
  return out;
}

}  // namespace kinemark::motion
