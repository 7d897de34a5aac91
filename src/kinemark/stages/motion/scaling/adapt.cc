// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/adapt.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/scaling/internal/moving_joint.h"
#include "kinemark/stages/motion/scaling/internal/projection.h"
#include "kinemark/stages/motion/scaling/internal/tissue.h"

namespace kinemark::motion {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using internal::Projection;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

constexpr int kStartIterations = 8;  // with strong priors, on few frames
constexpr std::int64_t kStartFrames = 80;
constexpr int kNoiseRounds = 4;  // until the noise agrees with the residuals
constexpr double kSameNoise = 0.03;
constexpr double kNoPlacePrior_m = 1.0;
constexpr double kTold = 0.5;  // share of its prior that a determined parameter's deviation stays below
constexpr double kLeastNoise_m = 1e-5;
constexpr double kSettled = 0.1;  // standard deviations that a step which no longer helps may have left to go

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

/// The whole estimate, step by step.
class Adaptation {
 public:
  Adaptation(const data::ModelDescription& model, const data::Trajectories& markers,
             const std::vector<GeometryParameter>& parameters, const AdaptOptions& options,
             internal::Problem problem, MatrixXd states, const Progress& progress)
      : full_(model),
        parameters_(parameters),
        options_(options),
        projection_(model, parameters, std::move(problem), options.ik, markers, options.threads),
        states_(std::move(states)),
        markers_(markers),
        progress_(progress),
        x_(VectorXd::Zero(static_cast<Index>(parameters.size()))) {}

  Status run(AdaptResult& result) {
    result.frames = markers_.frames();
    projection_.set_frames(1);
    result.rms_before_m = projection_.solve(x_, states_).rms();
    noise_m_ = options_.start_noise_sd_m;
    projection_.set_frames(std::max<std::int64_t>(1, markers_.frames() / kStartFrames));
    if (auto s = iterate(kStartIterations, result); !s) return s;
    projection_.set_frames(1);
    sums_ = projection_.solve(x_, states_);
    if (projection_.free_caught_frames(states_) > 0) sums_ = projection_.solve(x_, states_);
    noise_m_ = options_.marker_noise_sd_m > 0.0 ? options_.marker_noise_sd_m : residual_noise();
    for (int round = 0; round < kNoiseRounds; ++round) {
      if (auto s = iterate(options_.max_iterations, result); !s) return s;
      const double seen = options_.marker_noise_sd_m > 0.0 ? noise_m_ : residual_noise();
      const bool same = std::abs(seen - noise_m_) < kSameNoise * noise_m_;
      noise_m_ = seen;
      if (projection_.free_caught_frames(states_) == 0 && same) break;
    }
    result.noise_sd_m = noise_m_;
    if (auto s = find_covariance(result); !s) return s;
    result.rms_after_m = sums_.rms();
    describe(result);
    return {};
  }

 private:
  /// Weight of every parameter's prior in units of the squares.
  [[nodiscard]] VectorXd priors(double place_sd = 0.0) const {
    VectorXd weight(x_.size());
    for (Index k = 0; k < weight.size(); ++k) {
      const auto& parameter = parameters_[at(k)];
      const bool free_place = place_sd > 0.0 && parameter.kind == ParameterKind::marker_place;
      const double sd = free_place ? std::max(place_sd, parameter.prior_sd) : parameter.prior_sd;
      weight[k] = noise_m_ * noise_m_ / (sd * sd);
    }
    return weight;
  }

  [[nodiscard]] double residual_noise() const {
    const double freedom = 3.0 * static_cast<double>(sums_.normal.seen) -
                           static_cast<double>(sums_.moved_speeds) - static_cast<double>(x_.size());
    return std::max(kLeastNoise_m, std::sqrt(sums_.normal.squares / std::max(1.0, freedom)));
  }

  [[nodiscard]] double cost(const internal::ProjectedSums& sums, const VectorXd& x,
                            const VectorXd& prior) const {
    return sums.cost + (prior.array() * x.array().square()).sum();
  }

  /// Levenberg-Marquardt on the Schur complement, from where we are.
  Status iterate(int limit, AdaptResult& result) {
    const VectorXd prior = priors();
    sums_ = projection_.solve(x_, states_);
    double now = cost(sums_, x_, prior), damping = 1e-4;
    result.converged = false;
    if (!std::isfinite(now))
      return fail(Code::bad_input, "the recording gives distances that are not finite");
    for (int i = 0; i < limit; ++i) {
      if (progress_ && !progress_(result.iterations, result.iterations + limit - i))
        return fail(Code::cancelled, "adapting the model was stopped");
      ++result.iterations;
      MatrixXd S = sums_.normal.S.selfadjointView<Eigen::Lower>();
      S.diagonal() += prior;
      const VectorXd g = sums_.normal.g - prior.cwiseProduct(x_);
      bool better = false;
      double drop = 0.0, ahead = std::numeric_limits<double>::infinity();
      for (int trial = 0; trial < 8 && !better; ++trial) {
        MatrixXd A = S;
        A.diagonal() += damping * (S.diagonal().array() + 1e-6 * S.diagonal().maxCoeff()).matrix();
        const Eigen::LLT<MatrixXd> llt(A);
        const VectorXd step = llt.solve(g);
        if (llt.info() != Eigen::Success || !step.allFinite()) {
          damping *= 10.0;
          continue;
        }
        // What the quadratic model promises of the first, boldest step.
        if (!std::isfinite(ahead)) ahead = 2.0 * g.dot(step) - step.dot(S * step);
        const VectorXd x_try = x_ + step;
        MatrixXd states_try = states_;
        auto sums = projection_.solve(x_try, states_try);
        const double then = cost(sums, x_try, prior);
        if (then < now) {
          better = true;
          drop = (now - then) / now;
          now = then;
          x_ = x_try;
          states_ = std::move(states_try);
          sums_ = std::move(sums);
          damping = std::max(1e-9, 0.1 * damping);
        } else {
          damping *= 10.0;
        }
      }
      if (better && drop > 1e-7) continue;
      if (!better) sums_ = projection_.solve(x_, states_);  // the trials have moved its model
      result.converged = better || ahead <= std::max(1e-7 * now, std::pow(kSettled * noise_m_, 2));
      break;
    }
    return {};
  }

  [[nodiscard]] MatrixXd inverse(const VectorXd& prior) const {
    MatrixXd S = sums_.normal.S.selfadjointView<Eigen::Lower>();
    S.diagonal() += prior;
    S.diagonal().array() += 1e-14 * S.diagonal().maxCoeff();
    return S.llt().solve(MatrixXd::Identity(S.rows(), S.cols()));
  }

  /// Covariance with and without the prior of the places.
  Status find_covariance(AdaptResult& result) {
    internal::TissueModel tissue;
    std::optional<internal::TissuePass> pass;
    for (int round = 0; options_.soft_tissue && round < 2; ++round) {
      const auto variances = estimate_variances(projection_.problem(), markers_, states_, options_.threads);
      pass.emplace(projection_.problem(), projection_.layout(), markers_, states_, options_.threads);
      tissue = pass->detect(variances);
      if (!tissue.found || round == 1) break;
      // Samples that depend on each other count less against the priors.
      noise_m_ = result.noise_sd_m * std::sqrt(tissue.inflation);
      if (auto s = iterate(options_.max_iterations, result); !s) return s;
      result.noise_sd_m = options_.marker_noise_sd_m > 0.0 ? options_.marker_noise_sd_m : residual_noise();
    }
    result.tissue_sd_m = tissue.found ? tissue.sd_m : 0.0;
    const double s2 = noise_m_ * noise_m_;
    const auto covariance = [&](double place_sd) {
      const VectorXd prior = priors(place_sd);
      const MatrixXd inverse_S = inverse(prior);
      if (!tissue.found) return MatrixXd(s2 * inverse_S);
      MatrixXd middle = pass->middle(tissue, inverse_S);
      middle.diagonal() += s2 * prior;
      return MatrixXd(inverse_S * middle * inverse_S);
    };
    result.covariance = covariance(0.0);
    data_covariance_ = covariance(kNoPlacePrior_m);
    if (!result.covariance.allFinite() || !data_covariance_.allFinite())
      return fail(Code::bad_input,
                  "these data give no finite deviations of sizes; give more frames or markers");
    return {};
  }

  void describe(AdaptResult& result) const {
    result.model = apply_geometry(full_, parameters_, x_);
    for (Index k = 0; k < x_.size(); ++k) {
      const auto& parameter = parameters_[at(k)];
      AdaptedParameter out{.name = parameter.name,
                           .kind = parameter.kind,
                           .initial = parameter.initial,
                           .value = parameter.initial + x_[k],
                           .prior_sd = parameter.prior_sd,
                           .sd = std::sqrt(std::max(0.0, result.covariance(k, k))),
                           .data_sd = std::sqrt(std::max(0.0, data_covariance_(k, k)))};
      const bool place = parameter.kind == ParameterKind::marker_place;
      out.determined = (place ? out.sd : out.data_sd) < kTold * parameter.prior_sd;
      if (!out.determined && !place) result.not_determined.push_back(parameter.name);
      result.parameters.push_back(std::move(out));
    }
    describe_lengths(result);
    result.recommendations =
        internal::recommend_joints(projection_.problem(), markers_, states_, result.noise_sd_m);
  }

  void describe_lengths(AdaptResult& result) const {
    const auto before = segment_lengths(full_);
    for (const auto& length : before) {
      const auto& own = result.model.joints[at(length.first_joint)].child_from_joint.translation;
      const auto& next = result.model.joints[at(length.second_joint)].parent_from_joint.translation;
      const Eigen::Vector3d span = next - own;
      VectorXd gradient = VectorXd::Zero(x_.size());
      for (Index k = 0; k < x_.size(); ++k)
        for (const auto& term : parameters_[at(k)].terms) {
          const bool far = term.moves == GeometryTerm::Moves::parent_frame && term.idx == length.second_joint;
          const bool near = term.moves == GeometryTerm::Moves::child_frame && term.idx == length.first_joint;
          if (far || near) gradient[k] += (far ? 1.0 : -1.0) * span.dot(term.direction) / span.norm();
        }
      if (gradient.norm() == 0.0) continue;  // not adapted
      double prior = 0.0;
      for (Index k = 0; k < x_.size(); ++k) prior += std::pow(gradient[k] * parameters_[at(k)].prior_sd, 2);
      const double told = std::sqrt(gradient.dot(data_covariance_ * gradient) / prior);
      AdaptedLength out{.name = length.name,
                        .initial_m = length.length_m,
                        .length_m = span.norm(),
                        .sd_m = std::sqrt(gradient.dot(result.covariance * gradient)),
                        .determined = told < kTold};
      if (!out.determined) result.not_determined.push_back(length.name);
      result.lengths.push_back(std::move(out));
    }
  }

  const data::ModelDescription& full_;
  const std::vector<GeometryParameter>& parameters_;
  const AdaptOptions& options_;
  Projection projection_;
  MatrixXd states_;
  const data::Trajectories& markers_;
  const Progress& progress_;
  VectorXd x_;
  MatrixXd data_covariance_;
  internal::ProjectedSums sums_{0};
  double noise_m_ = 0.0;
};

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
  // Limits help to find the first postures; afterwards they would only hide a wrong size.
  IkOptions first = options.ik;
  first.limits = given.ik.limits;
  const auto start = solve_ik(*compiled, *picked, first);
  if (!start) return std::unexpected(start.error());
  MatrixXd states(compiled->state_count(), picked->frames());
  const auto n = static_cast<std::int64_t>(compiled->coordinate_count());
  for (std::int64_t f = 0; f < picked->frames(); ++f)
    states.col(f) = model::state_from_coordinates(
        problem->model, Eigen::Map<const VectorXd>(start->motion.q.data() + f * n, n));
  AdaptResult result;
  Adaptation adaptation(model, *picked, parameters, options, std::move(*problem), std::move(states),
                        progress);
  if (auto s = adaptation.run(result); !s) return std::unexpected(s.error());
  return result;
}

}  // namespace kinemark::motion
