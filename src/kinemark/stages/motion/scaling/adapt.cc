// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/adapt.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/scaling/internal/adapt_report.h"
#include "kinemark/stages/motion/scaling/internal/adaptation.h"
#include "kinemark/stages/motion/scaling/internal/moving_joint.h"

namespace kinemark::motion {
namespace {

using Eigen::MatrixXd;

Status check_terms(const data::ModelDescription& model, const std::vector<GeometryParameter>& parameters) {
  if (parameters.empty()) return fail(Code::bad_input, "nothing to adapt: the list of parameters is empty");
  for (const auto& parameter : parameters) {
    if (!(parameter.prior_sd > 0.0) || !std::isfinite(parameter.prior_sd))
      return fail(Code::bad_input, fmt::format("parameter '{}' has a prior of {}; need a number above 0",
                                               parameter.name, parameter.prior_sd));
    for (const auto& term : parameter.terms) {
      const bool marker = term.moves == GeometryTerm::Moves::marker;
      const auto count = marker ? model.markers.size() : model.joints.size();
      bool good =
          term.idx >= 0 && at(term.idx) < count && term.direction.allFinite() && std::isfinite(term.rate);
      if (good && term.moves == GeometryTerm::Moves::translation)
        good = term.axis >= 0 && at(term.axis) < model.joints[at(term.idx)].axes.size();
      if (!good)
        return fail(Code::bad_input, fmt::format("parameter '{}' moves a {} that the model does not have",
                                                 parameter.name, marker ? "marker" : "joint"));
    }
  }
  return {};
}

Status check_joints(const data::ModelDescription& model, const std::vector<MeasuredJoint>& joints) {
  for (const auto& joint : joints) {
    const bool there =
        std::ranges::find(model.joints, joint.joint, &data::JointDescription::name) != model.joints.end();
    const bool markers =
        std::ranges::all_of(joint.markers, [&](int m) { return m >= 0 && at(m) < model.markers.size(); });
    if (!there || !markers || joint.markers.size() < 3 || joint.x.cols() != std::ssize(joint.markers) ||
        !joint.x.allFinite() || !joint.centre.allFinite() || !joint.covariance.allFinite())
      return fail(Code::bad_input,
                  fmt::format("measured joint '{}': need a joint of the model, three of its markers or more "
                              "and numbers that are finite",
                              joint.joint));
  }
  return {};
}

/// Every stride-th frame of the range that the options name.
Result<data::Trajectories> pick_frames(const model::Model& model, const data::Trajectories& markers,
                                       const AdaptOptions& options) {
  const auto problem = internal::make_problem(model, markers, options.ik);
  if (!problem) return std::unexpected(problem.error());
  const std::int64_t stride = (problem->frames + options.max_frames - 1) / options.max_frames;
  const std::int64_t count = (problem->frames + stride - 1) / stride;
  auto picked = data::Trajectories::all_missing(
      markers.names, {.rate_hz = markers.time.rate_hz / static_cast<double>(stride),
                      .t0_s = markers.time.time_s(problem->first_frame),
                      .frames = count});
  for (std::int64_t f = 0; f < count; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const std::int64_t from = problem->first_frame + f * stride;
      if (!markers.present(from, m)) continue;
      picked.x(f, m) = markers.x(from, m);
      picked.state[picked.index(f, m)] = data::SampleState::measured;
    }
  return picked;
}

}  // namespace

Status AdaptOptions::check() const {
  if (auto s = ik.check(); !s) return s;
  if (ik.loss != Loss::square)
    return fail(Code::usage, "adapting a model needs the square loss; choose --loss square");
  for (const auto& task : ik.coordinate_tasks)
    if (!task.values.empty())
      return fail(Code::usage, fmt::format("the task of coordinate '{}' changes with time; adapting a model "
                                           "takes tasks with one value only",
                                           task.coordinate));
  if (!(marker_noise_sd_m >= 0.0 && marker_noise_sd_m < 1.0))
    return fail(Code::usage, fmt::format("a marker noise of {} m; need 0 to 1", marker_noise_sd_m));
  if (!(start_noise_sd_m > 0.0 && start_noise_sd_m < 1.0))
    return fail(Code::usage, fmt::format("a start noise of {} m; need above 0, below 1", start_noise_sd_m));
  if (max_frames < 2) return fail(Code::usage, fmt::format("at most {} frames; need 2 or more", max_frames));
  if (max_iterations < 1)
    return fail(Code::usage, fmt::format("at most {} iterations; need 1 or more", max_iterations));
  return {};
}

Result<AdaptResult> adapt_model(const data::ModelDescription& model, const data::Trajectories& markers,
                                const std::vector<GeometryParameter>& parameters, const AdaptOptions& given,
                                const Progress& progress) {
  AdaptOptions options = given;
  options.ik.limits = false;
  options.ik.error_bars = false;
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = check_terms(model, parameters); !s) return std::unexpected(s.error());
  if (auto s = check_joints(model, options.joints); !s) return std::unexpected(s.error());
  if (!model.point_constraints.empty())
    return fail(
        Code::not_supported,
        fmt::format("model '{}' has closed loops ({} point constraints); sizes are adapted on open trees "
                    "only",
                    model.name, model.point_constraints.size()));
  const auto compiled = model::Model::compile(model);
  if (!compiled) return std::unexpected(compiled.error());
  const auto picked = pick_frames(*compiled, markers, options);
  if (!picked) return std::unexpected(picked.error());
  options.ik.first_time_s = -1e300;
  options.ik.last_time_s = 1e300;
  auto problem = internal::make_problem(*compiled, *picked, options.ik);
  if (!problem) return std::unexpected(problem.error());
  problem->weight /= problem->weight.mean();  // noise and priors are weighed against markers of weight 1
  // Limits help to find the first postures; afterwards they would conceal a wrong size.
  IkOptions first = options.ik;
  first.limits = given.ik.limits;
  first.judge_samples = false;  // the frames picked lie far apart
  const auto start = solve_ik(*compiled, *picked, first);
  if (!start) return std::unexpected(start.error());
  MatrixXd states(compiled->state_count(), picked->frames());
  const auto n = static_cast<std::int64_t>(compiled->coordinate_count());
  for (std::int64_t f = 0; f < picked->frames(); ++f)
    states.col(f) = model::state_from_coordinates(
        problem->model, Eigen::Map<const Eigen::VectorXd>(start->motion.q.data() + f * n, n));
  AdaptResult result;
  internal::Adaptation adaptation(model, *picked, parameters, options, std::move(*problem), std::move(states),
                                  progress);
  if (auto s = adaptation.run(result); !s) return std::unexpected(s.error());
  for (std::int64_t f = 0; f < picked->frames(); ++f) result.time_s.push_back(picked->time.time_s(f));
  internal::describe(model, parameters, adaptation.change(), adaptation.data_covariance(), result);
  result.recommendations =
      internal::recommend_joints(adaptation.problem(), *picked, adaptation.states(), result.noise_sd_m);
  return result;
}

void add_geometry_error(const AdaptResult& adapted, data::JointMotion& motion) {
  if (motion.q_sd.empty() || adapted.time_s.empty()) return;
  check(adapted.coordinate_sd.rows() == motion.size(), "the motion has the coordinates of the adapted model");
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const double now = motion.time.time_s(f);
    auto after = std::ranges::lower_bound(adapted.time_s, now);
    if (after == adapted.time_s.end() || (after != adapted.time_s.begin() && now - after[-1] < *after - now))
      --after;
    const auto sd = adapted.coordinate_sd.col(after - adapted.time_s.begin());
    for (std::int64_t c = 0; c < motion.size(); ++c)
      if (const auto i = motion.index(f, c); motion.determined[i] != 0)
        internal::widen(motion, i, sd[c] * sd[c]);
  }
}

}  // namespace kinemark::motion
