// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/ik_estimate.h"

#include <utility>

#include "kinemark/stages/motion/smoother/camera_observations.h"
#include "kinemark/stages/motion/smoother/smoother.h"

namespace kinemark::pipeline {
namespace {

motion::IkResult in_terms_of_ik(motion::SmootherResult smooth) {
  motion::IkResult result;
  result.motion = std::move(smooth.motion);
  result.fit = std::move(smooth.fit);
  result.iterations = smooth.iterations;
  result.solve_seconds = smooth.start_seconds + smooth.solve_seconds;
  return result;
}

}  // namespace

Result<MotionEstimate> estimate_motion(const IkJob& job, const model::Model& model,
                                       const data::Trajectories& markers, const data::ImageTracks* images,
                                       const workflow::Axes& axes) {
  MotionEstimate estimate;
  motion::RateErrors errors;
  if (job.estimator == Estimator::smoother) {
    const motion::SmootherOptions options{.ik = job.options, .error_bars = job.options.error_bars};
    auto smooth = images == nullptr ? motion::smooth_motion(model, markers, options, job.progress)
                                    : motion::smooth_images(model, *images, markers, options, job.progress);
    if (!smooth) return fail_at(job.markers.string(), smooth.error());
    errors = std::move(smooth->errors);
    estimate.ik = in_terms_of_ik(std::move(*smooth));
  } else {
    if (images != nullptr)
      return fail(Code::usage, "least squares cannot use images; give --estimator smoother");
    auto solved = motion::solve_ik(model, markers, job.options, job.progress);
    if (!solved) return fail_at(job.markers.string(), solved.error());
    estimate.ik = std::move(*solved);
  }
  if (!job.torques) return estimate;
  auto torques = add_torques(model, estimate.ik.motion, job.forces,
                             {.error_bars = job.options.error_bars, .threads = job.options.threads},
                             errors.covariance.empty() ? nullptr : &errors, axes);
  if (!torques) return std::unexpected(torques.error());
  estimate.torques = std::move(*torques);
  return estimate;
}

}  // namespace kinemark::pipeline
