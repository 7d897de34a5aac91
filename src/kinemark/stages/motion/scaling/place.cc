// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/place.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/data/name_index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/ik.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

/// The mean of every marker over the time range, as a recording of one frame.
Result<data::Trajectories> average(const data::Trajectories& trial, const PlaceOptions& options) {
  const double slack = kTimeSlack / trial.time.rate_hz;
  auto mean = data::Trajectories::all_missing(
      trial.names, {.rate_hz = trial.time.rate_hz, .t0_s = trial.time.t0_s, .frames = 1});
  bool any = false;
  for (std::int64_t m = 0; m < trial.markers(); ++m) {
    Vector3d sum = Vector3d::Zero();
    Eigen::Array3d low = Eigen::Array3d::Constant(1e300), high = -low;
    double count = 0.0;
    for (std::int64_t f = 0; f < trial.frames(); ++f) {
      const double t = trial.time.time_s(f);
      if (t < options.ik.first_time_s - slack || t > options.ik.last_time_s + slack) continue;
      if (!any) mean.time.t0_s = t;
      any = true;
      if (!trial.present(f, m)) continue;
      sum += trial.x(f, m);
      low = low.min(trial.x(f, m).array());
      high = high.max(trial.x(f, m).array());
      count += 1.0;
    }
    if (count == 0.0) continue;
    const double moved = (high - low).maxCoeff();
    if (options.max_marker_movement_m >= 0.0 && moved > options.max_marker_movement_m)
      return fail(Code::bad_input,
                  fmt::format("marker '{}' moves by {:.1f} mm in the static trial; at most {:.1f} "
                              "mm is allowed",
                              trial.names[static_cast<std::size_t>(m)], 1e3 * moved,
                              1e3 * options.max_marker_movement_m));
    mean.x(0, m) = sum / count;
    mean.state[mean.index(0, m)] = data::SampleState::measured;
  }
  if (!any)
    return fail(Code::bad_input,
                fmt::format("the static trial has no frame between {} and {} s; it runs from {} "
                            "to {} s",
                            options.ik.first_time_s, options.ik.last_time_s, trial.time.t0_s,
                            trial.time.time_s(std::max<std::int64_t>(0, trial.frames() - 1))));
  return mean;
}

}  // namespace

Result<PlaceResult> place_markers(const data::ModelDescription& model, const data::Trajectories& static_trial,
                                  const PlaceOptions& options) {
  for (const auto& name : options.fixed)
    if (model.find_marker(name) < 0)
      return fail(Code::bad_input, fmt::format("fixed marker '{}' is not in the model", name));
  const auto frame = average(static_trial, options);
  if (!frame) return std::unexpected(frame.error());
  const auto compiled = model::Model::compile(model);
  if (!compiled) return std::unexpected(compiled.error());
  IkOptions ik = options.ik;
  ik.first_time_s = -1e300;
  ik.last_time_s = 1e300;
  ik.error_bars = false;
  ik.judge_samples = false;
  const auto solved = solve_ik(*compiled, *frame, ik);
  if (!solved) return std::unexpected(solved.error());

  PlaceResult result{.model = model, .rms_m = solved->fit.rms_error_m};
  result.pose = Eigen::Map<const Eigen::VectorXd>(solved->motion.q.data(), compiled->coordinate_count());
  model::Workspace w(*compiled);
  model::kinematics(*compiled, w, model::state_from_coordinates(*compiled, result.pose));
  const data::NameIndex index(frame->names);
  for (std::size_t i = 0; i < model.markers.size(); ++i) {
    auto& marker = result.model.markers[i];
    const auto recorded = index.find(marker.name);
    if (recorded < 0 || !frame->present(0, recorded)) {
      result.unseen.push_back(marker.name);
      continue;
    }
    const Vector3d measured = frame->x(0, recorded);
    const int body = compiled->markers()[i].body;
    PlacedMarker placed{
        .name = marker.name,
        .body = body < 0 ? "ground" : model.bodies[static_cast<std::size_t>(marker.body_idx)].name,
        .before_in_body = marker.x_in_body,
        .error_m = (measured - w.marker.col(static_cast<Eigen::Index>(i))).norm(),
        .fixed = std::ranges::find(options.fixed, marker.name) != options.fixed.end()};
    if (!placed.fixed) {
      const auto b = static_cast<std::size_t>(body);
      marker.x_in_body =
          body < 0 ? measured : Vector3d(w.rotation[b].transpose() * (measured - w.position[b]));
    }
    placed.after_in_body = marker.x_in_body;
    result.markers.push_back(std::move(placed));
  }
  return result;
}

}  // namespace kinemark::motion
