// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/ik_estimate.h"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "kinemark/stages/motion/smoother/smoother.h"

namespace kinemark::pipeline {
namespace {

motion::IkResult in_terms_of_ik(motion::SmootherResult smooth) {
  motion::IkResult result;
  result.motion = std::move(smooth.motion);
  result.first_frame = smooth.first_frame;
  result.markers = std::move(smooth.markers);
  result.model_markers_without_data = std::move(smooth.model_markers_without_data);
  result.data_markers_without_model = std::move(smooth.data_markers_without_model);
  result.excluded_markers = std::move(smooth.excluded_markers);
  result.warnings = std::move(smooth.warnings);
  result.rms_marker_error_m = smooth.rms_marker_error_m;
  result.max_marker_error_m = smooth.max_marker_error_m;
  result.mean_marker_error_m = smooth.mean_marker_error_m;
  result.max_loop_gap_m = smooth.max_loop_gap_m;
  result.iterations = smooth.iterations;
  result.solve_seconds = smooth.start_seconds + smooth.solve_seconds;
  return result;
}

}  // namespace

Result<motion::IkResult> estimate_motion(const IkJob& job, const model::Model& model,
                                         const data::Trajectories& markers, const Progress& progress) {
  motion::IkResult result;
  motion::RateErrors errors;
  if (job.estimator == Estimator::smoother) {
    auto smooth = motion::smooth_motion(model, markers,
                                        {.ik = job.options, .error_bars = job.options.error_bars}, progress);
    if (!smooth) return std::unexpected(smooth.error());
    errors = std::move(smooth->errors);
    result = in_terms_of_ik(std::move(*smooth));
  } else {
    auto solved = motion::solve_ik(model, markers, job.options, progress);
    if (!solved) return std::unexpected(solved.error());
    result = std::move(*solved);
  }
  if (!job.torques) return result;
  const motion::DynamicsOptions options{.error_bars = job.options.error_bars, .threads = job.options.threads};
  const auto dynamics = motion::inverse_dynamics(model, result.motion, options, nullptr,
                                                 errors.covariance.empty() ? nullptr : &errors);
  if (!dynamics) return std::unexpected(dynamics.error());
  result.warnings.insert(result.warnings.end(), dynamics->warnings.begin(), dynamics->warnings.end());
  for (const auto& root : dynamics->roots)
    result.warnings.push_back(
        fmt::format("torques are without force plates: '{}' is carried by {:.0f} N and {:.0f} N m RMS (body "
                    "weight {:.0f} "
                    "N), so that the torques of limbs on the ground lack what the ground does",
                    root.body, root.force_rms_n, root.moment_rms_nm, dynamics->body_weight_n));
  return result;
}

}  // namespace kinemark::pipeline
