// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What `kinemark ik` computes: coordinates by the estimator that the job names, torques when asked.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/image_tracks.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/motion/torques.h"

namespace kinemark::pipeline {

/// Joint angles by either estimator, with torques where asked for.
struct MotionEstimate {
  motion::IkResult ik;    ///< motion and fit
  TorqueAccount torques;  ///< empty unless they were asked for
};

/// Least squares or the whole-trajectory smoother, both with the result type of the former; with torques
/// (and, for least squares, estimated rates) in the motion when the job asks for them. Failures name the
/// file. With images the smoother fits these, started from the markers; least squares cannot use images.
/// @param axes  how the recording was turned; forces are turned alike
[[nodiscard]] Result<MotionEstimate> estimate_motion(const IkJob& job, const model::Model& model,
                                                     const data::Trajectories& markers,
                                                     const data::ImageTracks* images = nullptr,
                                                     const workflow::Axes& axes = {});

}  // namespace kinemark::pipeline
