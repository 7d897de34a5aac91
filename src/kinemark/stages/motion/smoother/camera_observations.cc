// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/camera_observations.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/camera/projection.h"
#include "kinemark/core/check.h"
#include "kinemark/stages/motion/smoother/internal/run.h"

namespace kinemark::motion {

CameraObservations::CameraObservations(const data::ImageTracks& tracks, std::vector<int> column,
                                       std::int64_t first_frame, double huber_sd)
    : tracks_(tracks), column_(std::move(column)), first_frame_(first_frame), huber_sd_(huber_sd) {}

void CameraObservations::linearize(std::int64_t f, const Eigen::Matrix3Xd& p, MarkerInformation& out) const {
  check(static_cast<std::size_t>(p.cols()) == column_.size(),
        "need one column of the tracks for every marker");
  out.clear(p.cols(), true);
  for (std::size_t m = 0; m < column_.size(); ++m)
    for (std::size_t c = 0; column_[m] >= 0 && c < tracks_.cameras.size(); ++c) {
      const Eigen::Vector2d seen = tracks_.at(first_frame_ + f, c, static_cast<std::size_t>(column_[m]));
      if (!seen.allFinite()) continue;
      const auto there = camera::project(tracks_.cameras[c], p.col(static_cast<Eigen::Index>(m)));
      if (!there.in_front || !there.image.allFinite()) continue;
      const Eigen::Vector2d residual = (seen - there.image) / tracks_.noise_sd[c];
      const Eigen::Matrix<double, 2, 3> slope = there.d_point / tracks_.noise_sd[c];
      const double r = residual.norm();
      const bool beyond = huber_sd_ > 0.0 && r > huber_sd_;
      const double share = beyond ? huber_sd_ / r : 1.0;
      out.descent.col(static_cast<Eigen::Index>(m)) += share * (slope.transpose() * residual);
      out.full[m] += share * (slope.transpose() * slope);
      out.cost += beyond ? huber_sd_ * (r - 0.5 * huber_sd_) : 0.5 * r * r;
    }
}

Result<SmootherResult> smooth_images(const model::Model& model, const data::ImageTracks& tracks,
                                     const data::Trajectories& markers, const SmootherOptions& options,
                                     const Progress& progress) {
  if (auto status = tracks.validate(); !status) return std::unexpected(status.error());
  if (tracks.frames() != markers.frames() || tracks.time.rate_hz != markers.time.rate_hz)
    return fail(Code::bad_input,
                fmt::format("image tracks have {} frames at {} Hz, the markers {} at {} Hz; need the same",
                            tracks.frames(), tracks.time.rate_hz, markers.frames(), markers.time.rate_hz));
  auto prepared = internal::prepare(model, markers, options, progress);
  if (!prepared) return std::unexpected(prepared.error());
  const auto& problem = prepared->problem;
  std::vector<int> column;
  for (const int m : problem.data_marker) {
    const auto it = std::ranges::find(tracks.names, markers.names[static_cast<std::size_t>(m)]);
    column.push_back(it == tracks.names.end() ? -1 : static_cast<int>(it - tracks.names.begin()));
  }
  if (std::ranges::all_of(column, [](int c) { return c < 0; }))
    return fail(Code::bad_input, "the image tracks have no marker in common with model and recording");
  auto noise =
      internal::split_noise(problem, prepared->start, options.ik.marker_noise_sd_m, options.huber_sd);
  noise.slow.setZero();  // of images nobody knows it
  noise.common_slow.setZero();
  const CameraObservations observations(tracks, std::move(column), problem.first_frame, options.huber_sd);
  return internal::run(*prepared, prepared->believed(markers), observations, noise, options, progress);
}

}  // namespace kinemark::motion
