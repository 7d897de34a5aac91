// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/track.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "kinemark/data/calibration_error.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/resample_forces.h"
#include "kinemark/stages/motion/control/camera_task.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/workflow/motion/internal/held_motion.h"
#include "kinemark/workflow/motion/used_markers.h"
#include "kinemark/workflow/prepare/contradictions.h"

namespace kinemark::workflow {
namespace {

/// Standard deviations of the torques, from inverse dynamics of the resulting motion. Where that is not
/// possible (closed loops, few frames) they are absent, with a warning.
void add_torque_deviations(const model::Model& model, const TrackOptions& options,
                           motion::TrackResult& result) {
  auto motion = result.motion;
  const auto dynamics = motion::inverse_dynamics(model, motion, {.threads = options.track.threads});
  if (dynamics)
    result.motion.tau_sd = std::move(motion.tau_sd);
  else
    result.fit.warnings.push_back("standard deviations of torques are not known: " +
                                  dynamics.error().message);
}

/// The images join the lowest level.
Status add_images(const model::Model& model, const data::ImageTracks* images, motion::TrackOptions& options) {
  if (images == nullptr) return {};
  if (options.propose_levels)
    return fail(Code::usage, "levels cannot be proposed where points of images are goals; name them");
  const auto tasks =
      motion::camera_tasks(model, *images, {.cutoff_hz = options.cutoff_hz, .fade_s = options.fade_s});
  if (!tasks) return std::unexpected(tasks.error());
  if (options.levels.empty()) options.levels.push_back({.markers = {"*"}, .tasks = {}});
  auto& lowest = options.levels.back().tasks;
  lowest.insert(lowest.end(), tasks->begin(), tasks->end());
  return {};
}

/// Weight of a marker's squared errors among all that are followed: its own times that of its level.
double weight_of(const std::string& marker, const motion::TrackOptions& asked,
                 const motion::TrackResult& result) {
  const auto& levels = result.proposed ? result.proposed->levels : asked.levels;
  const auto own = std::ranges::find(asked.marker_weights, marker, &motion::MarkerWeight::marker);
  double weight = own != asked.marker_weights.end() ? own->weight : 1.0;
  const auto names = [&](const std::string& name) {
    return std::ranges::find_if(
        levels, [&](const auto& level) { return std::ranges::count(level.markers, name) > 0; });
  };
  auto level = names(marker);
  if (level == levels.end()) level = names("*");
  const auto index = static_cast<std::size_t>(level - levels.begin());
  if (index < result.levels.size() && result.levels[index].weight > 0.0)
    weight *= result.levels[index].weight;
  return weight;
}

/// The body follows displaced markers as least squares of the same weights does, to first order.
Status add_calibration_part(const model::Model& model, const data::Recording& recording,
                            const motion::TrackOptions& asked, motion::TrackResult& result) {
  motion::IkOptions ik{.default_marker_weight = 0.0,
                       .first_time_s = asked.first_time_s,
                       .last_time_s = asked.last_time_s,
                       .threads = asked.threads};
  for (const auto& marker : result.fit.markers)
    ik.marker_weights.push_back({.marker = marker.name, .weight = weight_of(marker.name, asked, result)});
  return motion::add_calibration_error(model, recording.trial.markers, recording.trial.calibration_error, ik,
                                       result.motion);
}

Status find_torques(const model::Model& model, const data::Recording& recording, const TrackOptions& options,
                    TrackFound& found) {
  auto& motion = found.result.motion;
  if (!recording.plates) {
    if (options.track.error_bars) add_torque_deviations(model, options, found.result);
    return {};
  }
  const auto forces = resample(*recording.plates, motion.time);
  auto torques = add_torques(model, motion, &forces,
                             {.error_bars = options.track.error_bars, .threads = options.track.threads});
  if (!torques) return std::unexpected(torques.error());
  found.torques = std::move(*torques);
  return {};
}

std::optional<data::Trajectories> markers_of(const data::Trajectories& recorded,
                                             const motion::TrackResult& result) {
  const auto& motion = result.motion;
  const auto last = result.fit.first_frame + motion.frames();
  if (motion.time.rate_hz != recorded.time.rate_hz || last > recorded.frames()) return std::nullopt;
  return solved_markers(recorded, result.fit, motion);
}

/// No frame may have a strict level beyond its bound.
void add_level_gate(Gates& gates, const motion::TrackResult& result) {
  const std::size_t L = result.levels.size();
  if (L == 0 || std::isnan(result.levels.front().bound_m)) return;
  std::int64_t beyond = 0;
  for (std::size_t f = 0; f < result.relaxed.size(); ++f)
    for (std::size_t i = 0; i < L; ++i)
      if (result.level_error[f * L + i] > result.levels[i].bound_m) {
        ++beyond;
        break;
      }
  add_gate(
      gates, "levels", static_cast<double>(beyond), 0.0, "frames",
      fmt::format("In {} of {} frames a strict level is beyond its bound.", beyond, result.motion.frames()));
}

/// The accuracy that was chosen for knows noise, filter and steps: said where the markers lie farther from
/// the model than noise puts them.
std::string note_on_accuracy(const motion::TrackResult& result) {
  constexpr double kBeyondNoise = 2.0;
  if (!result.accuracy) return {};
  const double noise_m = std::sqrt(3.0) * result.accuracy->noise_sd_m, off_m = result.fit.rms_error_m;
  if (!(off_m > kBeyondNoise * noise_m)) return {};
  return fmt::format(
      "the expected error is that of noise, filter and steps: markers lie {:.1f} mm RMS from this model, of "
      "which "
      "noise makes {:.1f} mm; what the model's sizes and skin put into the angles is not in it, and "
      "deviations of "
      "the angles hold what the residuals show of it",
      1e3 * off_m, 1e3 * noise_m);
}

void add_gates(Gates& gates, const MarkerBounds& bounds, const motion::TrackResult& result) {
  const double offset_m = result.fit.mean_error_m.norm();
  add_marker_gates(gates, bounds, offset_m,
                   fmt::format("The mean of all marker errors is {:.1f} mm long.", 1e3 * offset_m),
                   result.fit.rms_error_m);
  add_frames_gate(gates, "flagged", result.flagged_frames, result.motion.frames(),
                  fmt::format("are flagged: goals out of reach, or a body that ran away ({} times "
                              "started anew)",
                              result.restarts));
  add_level_gate(gates, result);
  add_left_out_gate(gates, result.motion);
}

}  // namespace

Result<TrackFound> track(const model::Model& model, const data::Recording& recording,
                         const TrackOptions& options) {
  auto asked = options.track;
  if (auto s = add_images(model, options.images, asked); !s) return std::unexpected(s.error());
  const auto& markers = recording.trial.markers;
  auto result = motion::track_markers(model, markers, asked, options.progress);
  if (!result) return std::unexpected(result.error());
  TrackFound found;
  found.result = std::move(*result);
  if (auto s = add_calibration_part(model, recording, options.track, found.result); !s)
    return std::unexpected(s.error());
  if (auto s = find_torques(model, recording, options, found); !s) return std::unexpected(s.error());
  const auto& fit = found.result.fit;
  found.used = markers_of(markers, found.result);
  auto& warnings = found.remarks.warnings;
  warnings = fit.warnings;
  std::ranges::move(data::describe_all(fit.findings, found.result.motion.time), std::back_inserter(warnings));
  std::ranges::copy(found.torques.warnings, std::back_inserter(warnings));
  if (options.track.error_bars)
    if (auto note = data::note_held("Deviations of coordinates",
                                    data::rms_of(recording.trial.calibration_error, markers));
        !note.empty())
      warnings.push_back(std::move(note));
  if (auto note = note_on_accuracy(found.result); !note.empty()) warnings.push_back(std::move(note));
  add_gates(found.remarks.gates, options.bounds, found.result);
  std::ranges::copy(found.torques.gates, std::back_inserter(found.remarks.gates));
  add_contradictions(recording.contradicted, found.remarks.gates);
  internal::hold_model(model, found.result.motion, found.remarks);
  return found;
}

}  // namespace kinemark::workflow
