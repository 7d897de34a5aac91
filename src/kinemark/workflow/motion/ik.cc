// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/ik.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "kinemark/data/calibration_error.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/resample_forces.h"
#include "kinemark/stages/motion/smoother/camera_observations.h"
#include "kinemark/stages/motion/smoother/smoother.h"
#include "kinemark/workflow/motion/internal/held_motion.h"
#include "kinemark/workflow/motion/used_markers.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::workflow {
namespace {

/// One sentence on the offset between recording and model when they do not coincide.
std::string offset_sentence(const motion::IkResult& result, const IkOptions& options,
                            const model::Model& model, const data::Trajectories& markers) {
  const auto& mean = result.fit.mean_error_m;
  if (!mean.allFinite()) return {};  // no marker is seen, which the gate says
  std::string as_it_is = fmt::format("The mean of all marker errors is {:.1f} mm long.", 1e3 * mean.norm());
  if (mean.norm() <= options.bounds.max_offset_m) return as_it_is;
  const auto offset = motion::find_common_offset(model, markers, options.ik);
  if (!offset) return as_it_is;
  const auto& shift = offset->shift_m;
  return fmt::format(
      "The measured markers lie {:.3f} m away from the model: shifted by ({:+.3f}, {:+.3f}, {:+.3f}) m they "
      "would fit with "
      "{:.1f} mm RMS instead of {:.1f} mm. Check that recording and model share origin, axes and unit.",
      shift.norm(), shift.x(), shift.y(), shift.z(), 1e3 * offset->rms_after_m, 1e3 * result.fit.rms_error_m);
}

constexpr double kMostFramesOff = 5.0;  // %: frames that fit worse than a recording may as a whole

/// Gates of single frames and samples, which the RMS of a whole recording hides.
void add_frame_gates(Gates& gates, const IkOptions& options, const data::JointMotion& motion) {
  const auto M = motion.markers.size();
  std::int64_t off = 0, seen = 0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    double squares = 0.0;
    int count = 0;
    for (std::size_t m = 0; m < M; ++m) {
      const double* error = motion.marker_error.data() + 3 * (static_cast<std::size_t>(f) * M + m);
      if (std::isnan(error[0])) continue;
      squares += error[0] * error[0] + error[1] * error[1] + error[2] * error[2];
      ++count;
    }
    off += squares > count * options.bounds.max_rms_m * options.bounds.max_rms_m;
    seen += count > 0;
  }
  const auto percent = [](std::int64_t part, std::int64_t all) {
    return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
  };
  add_gate(gates, "frames_off", percent(off, seen), kMostFramesOff, "%",
           fmt::format("In {} of {} frames the RMS distance between measured and model markers is above "
                       "{:.1f} mm; at most {:g} % are accepted.",
                       off, seen, 1e3 * options.bounds.max_rms_m, kMostFramesOff));
  add_left_out_gate(gates, motion);
}

void add_gates(Gates& gates, const IkOptions& options, const model::Model& model,
               const data::Trajectories& markers, const motion::IkResult& result) {
  add_marker_gates(gates, options.bounds, result.fit.mean_error_m.norm(),
                   offset_sentence(result, options, model, markers), result.fit.rms_error_m);
  std::int64_t failed = 0;
  for (const auto status : result.motion.status) failed += status == data::FrameStatus::not_converged;
  add_frames_gate(gates, "not_converged", failed, result.motion.frames(), "did not converge");
  add_frame_gates(gates, options, result.motion);
  if (!std::isnan(result.fit.max_loop_gap_m) && result.fit.max_loop_gap_m > 0.0)
    add_gate(gates, "loop_gap", 1e3 * result.fit.max_loop_gap_m, 1e-3, "mm",
             fmt::format("The widest gap of a closed loop is {:.2g} mm; at most 0.001 mm is accepted.",
                         1e3 * result.fit.max_loop_gap_m));
}

motion::IkResult in_terms_of_ik(motion::SmootherResult smooth) {
  motion::IkResult result;
  result.motion = std::move(smooth.motion);
  result.fit = std::move(smooth.fit);
  result.iterations = smooth.iterations;
  result.solve_seconds = smooth.start_seconds + smooth.solve_seconds;
  return result;
}

/// Motion and fit by the estimator that is asked for; `errors` are those of the smoother's rates.
Result<motion::IkResult> estimate(const model::Model& model, const data::Trajectories& markers,
                                  const IkOptions& options, motion::RateErrors& errors) {
  if (options.estimator == Estimator::least_squares) {
    if (options.images != nullptr)
      return fail(Code::usage, "least squares cannot use images; give --estimator smoother");
    return motion::solve_ik(model, markers, options.ik, options.progress);
  }
  const motion::SmootherOptions smoother{.ik = options.ik, .error_bars = options.ik.error_bars};
  auto smooth = options.images == nullptr
                    ? motion::smooth_motion(model, markers, smoother, options.progress)
                    : motion::smooth_images(model, *options.images, markers, smoother, options.progress);
  if (!smooth) return std::unexpected(smooth.error());
  errors = std::move(smooth->errors);
  return in_terms_of_ik(std::move(*smooth));
}

Result<motion::IkResult> estimate_with_sensors(const model::Model& model, const data::Trajectories& markers,
                                               const IkOptions& options,
                                               std::optional<SensorsFound>& sensors) {
  if (options.estimator != Estimator::least_squares)
    return fail(Code::usage, "the smoother cannot use orientations; give --estimator least-squares");
  const auto& inputs = *options.sensors;
  auto mixed = motion::solve_mixed(model, markers, inputs.recording, inputs.pose ? &*inputs.pose : nullptr,
                                   options.ik, inputs.options, options.progress);
  if (!mixed) return std::unexpected(mixed.error());
  sensors = SensorsFound{.error_rad = std::move(mixed->error_rad), .fit = std::move(mixed->fit)};
  return std::move(mixed->ik);
}

Status find_torques(const model::Model& model, const data::Recording& recording, const IkOptions& options,
                    const motion::RateErrors& errors, IkFound& found) {
  auto& motion = found.result.motion;
  std::optional<data::Wrenches> forces;
  if (recording.plates) forces = resample(*recording.plates, motion.time);
  auto torques = add_torques(model, motion, forces ? &*forces : nullptr,
                             {.error_bars = options.ik.error_bars, .threads = options.ik.threads},
                             errors.covariance.empty() ? nullptr : &errors);
  if (!torques) return std::unexpected(torques.error());
  found.torques = std::move(*torques);
  return {};
}

}  // namespace

Result<Axes> bring_into_axes(const AxesChoice& choice, const std::string& name, data::Recording& recording,
                             const model::Model& model) {
  auto axes = bring_into_axes(choice, name, recording.trial, model);
  if (!axes || !recording.plates) return axes;
  turn(*recording.plates, axes->model_from_recording);
  auto off = check_forces(*recording.plates, *axes, model);
  if (!off) return fail_at(name, off.error());
  if (!off->empty()) recording.notes.push_back(std::move(*off));
  return axes;
}

Result<IkFound> ik(const model::Model& model, const data::Recording& recording, const IkOptions& options) {
  IkFound found;
  const auto& markers = recording.trial.markers;
  motion::RateErrors errors;
  auto result = options.sensors == nullptr ? estimate(model, markers, options, errors)
                                           : estimate_with_sensors(model, markers, options, found.sensors);
  if (!result) return std::unexpected(result.error());
  found.result = std::move(*result);
  const auto& calibration = recording.trial.calibration_error;
  if (auto s = motion::add_calibration_error(model, markers, calibration, options.ik, found.result.motion);
      !s)
    return std::unexpected(s.error());
  if (options.torques)
    if (auto s = find_torques(model, recording, options, errors, found); !s)
      return std::unexpected(s.error());
  const auto& motion = found.result.motion;
  const auto& fit = found.result.fit;
  found.used = solved_markers(markers, fit, motion);
  auto& [warnings, gates] = found.remarks;
  warnings = fit.warnings;
  if (options.ik.error_bars)
    if (auto note = data::note_held("Deviations of coordinates",
                                    data::rms_of(recording.trial.calibration_error, markers));
        !note.empty())
      warnings.push_back(std::move(note));
  std::ranges::move(data::describe_all(fit.findings, motion.time), std::back_inserter(warnings));
  std::ranges::copy(found.torques.warnings, std::back_inserter(warnings));
  add_gates(gates, options, model, markers, found.result);
  std::ranges::copy(found.torques.gates, std::back_inserter(gates));
  add_contradictions(recording.contradicted, gates);
  internal::hold_model(model, motion, found.remarks);
  return found;
}

}  // namespace kinemark::workflow
