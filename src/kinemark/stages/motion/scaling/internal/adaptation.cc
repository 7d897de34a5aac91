// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/adaptation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/scaling/internal/geometry_part.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kStartIterations = 8;  // with strong priors, on few frames
constexpr std::int64_t kStartFrames = 80;
constexpr int kNoiseRounds = 4;  // until the noise agrees with the residuals
constexpr double kSameNoise = 0.03;
constexpr double kLeastGain = 1e-7;  // of the cost
constexpr double kNoPositionPrior_m = 1.0;
constexpr double kLeastNoise_m = 1e-5;
constexpr double kSettled = 0.1;  // standard deviations: largest distance to the minimum after the last step
constexpr double kNear = 0.3;     // standard deviations: gain of a step below which settle() takes over
constexpr int kSettleSteps = 20;
constexpr int kQuietRounds = 3;
constexpr double kSameMotion = 0.1;  // shares of motion that need no further round
constexpr double kFarthest = 3.0;    // prior deviations that a parameter may go in one step
constexpr double kLeastSize = 0.2;   // of the model's: no segment is turned inside out
constexpr double kOfTheWay = 0.9;    // to the least size, at most, in one step

MatrixXd inverse(const NormalSums& sums, const MatrixXd& known) {
  MatrixXd S = sums.S.selfadjointView<Eigen::Lower>();
  S += known;
  S.diagonal().array() += 1e-14 * S.diagonal().maxCoeff();
  return S.llt().solve(MatrixXd::Identity(S.rows(), S.cols()));
}

}  // namespace

double Adaptation::share_of(const VectorXd& step) const {
  double share = 1.0;
  for (Index k = 0; k < step.size(); ++k) {
    const auto& parameter = parameters_[at(k)];
    const double room = x_[k] + (1.0 - kLeastSize) * parameter.initial;
    if (parameter.kind == ParameterKind::body_scale && step[k] < 0.0)
      share = std::min(share, kOfTheWay * room / -step[k]);
  }
  return share;
}

Adaptation::Adaptation(const data::ModelDescription& model, const data::Trajectories& markers,
                       const std::vector<GeometryParameter>& parameters, const AdaptOptions& options,
                       Problem problem, MatrixXd states, const Progress& progress)
    : parameters_(parameters),
      options_(options),
      projection_(model, parameters, std::move(problem), options.ik, markers, options.threads),
      joints_(model, parameters, options.joints),
      states_(std::move(states)),
      markers_(markers),
      progress_(progress),
      x_(VectorXd::Zero(static_cast<Index>(parameters.size()))) {}

Status Adaptation::run(AdaptResult& result) {
  result.frames = markers_.frames();
  projection_.set_frames(1);
  result.rms_before_m = projection_.solve(x_, states_).rms();
  noise_m_ = options_.start_noise_sd_m;
  projection_.set_frames(std::max<std::int64_t>(1, markers_.frames() / kStartFrames));
  if (auto s = iterate(kStartIterations, 0.0, result); !s) return s;
  projection_.set_frames(1);
  sums_ = projection_.solve(x_, states_);
  if (projection_.free_caught_frames(states_) > 0) sums_ = projection_.solve(x_, states_);
  noise_m_ = options_.marker_noise_sd_m > 0.0 ? options_.marker_noise_sd_m : residual_noise();
  for (int round = 0; round < kNoiseRounds; ++round) {
    if (auto s = iterate(options_.max_iterations, kNear, result); !s) return s;
    const double seen = options_.marker_noise_sd_m > 0.0 ? noise_m_ : residual_noise();
    const bool same = std::abs(seen - noise_m_) < kSameNoise * noise_m_;
    noise_m_ = seen;
    if (projection_.free_caught_frames(states_) == 0 && same) break;
  }
  result.noise_sd_m = noise_m_;
  if (auto s = find_covariance(result); !s) return s;
  result.rms_after_m = sums_.rms();
  return {};
}

Adaptation::Known Adaptation::known(const VectorXd& x, double position_sd) const {
  const double s2 = noise_m_ * noise_m_;
  const JointSums joints = joints_.sums(x);
  Known out{.S = s2 * joints.information, .g = s2 * joints.gradient, .cost = s2 * joints.squares};
  for (Index k = 0; k < x.size(); ++k) {
    const auto& parameter = parameters_[at(k)];
    const bool free_position = position_sd > 0.0 && parameter.kind == ParameterKind::marker_position;
    const double sd = free_position ? std::max(position_sd, parameter.prior_sd) : parameter.prior_sd;
    const double weight = s2 / (sd * sd);
    out.S(k, k) += weight;
    out.g[k] -= weight * x[k];
    out.cost += weight * x[k] * x[k];
  }
  return out;
}

double Adaptation::residual_noise() const {
  const double freedom = 3.0 * static_cast<double>(sums_.normal.seen) -
                         static_cast<double>(sums_.moved_speeds) - static_cast<double>(x_.size());
  return std::max(kLeastNoise_m, std::sqrt(sums_.normal.weighted_squares / std::max(1.0, freedom)));
}

/// Levenberg-Marquardt on the Schur complement, from the current geometry, until the gain of a step is below
/// that of least_sd standard deviations of a parameter.
Status Adaptation::iterate(int limit, double least_sd, AdaptResult& result) {
  sums_ = projection_.solve(x_, states_);
  double now = sums_.cost + known(x_).cost, damping = 1e-4;
  result.converged = false;
  if (!std::isfinite(now)) return fail(Code::bad_input, "the recording gives distances that are not finite");
  for (int i = 0; i < limit; ++i) {
    if (progress_ && !progress_(result.iterations, result.iterations + limit - i))
      return fail(Code::cancelled, "adapting the model was stopped");
    ++result.iterations;
    MatrixXd S = sums_.normal.S.selfadjointView<Eigen::Lower>();
    const Known besides = known(x_);
    S += besides.S;
    const VectorXd g = sums_.normal.g + besides.g;
    bool better = false;
    double won = 0.0, ahead = std::numeric_limits<double>::infinity();
    for (int trial = 0; trial < 8 && !better; ++trial) {
      MatrixXd A = S;
      A.diagonal() += damping * (S.diagonal().array() + 1e-6 * S.diagonal().maxCoeff()).matrix();
      const Eigen::LLT<MatrixXd> llt(A);
      const VectorXd step = llt.solve(g);
      if (llt.info() != Eigen::Success || !step.allFinite()) {
        damping *= 10.0;
        continue;
      }
      // Gain predicted by the quadratic model for the first, longest step.
      if (!std::isfinite(ahead)) ahead = 2.0 * g.dot(step) - step.dot(S * step);
      const VectorXd x_try = x_ + share_of(step) * step;
      MatrixXd states_try = states_;
      auto sums = projection_.solve(x_try, states_try);
      const double then = sums.cost + known(x_try).cost;
      if (then < now) {
        better = true;
        won = now - then;
        now = then;
        x_ = x_try;
        states_ = std::move(states_try);
        sums_ = std::move(sums);
        damping = std::max(1e-9, 0.1 * damping);
      } else {
        damping *= 10.0;
      }
    }
    if (better && won > std::max(kLeastGain * now, least_sd * least_sd * noise_m_ * noise_m_)) continue;
    if (!better) sums_ = projection_.solve(x_, states_);  // the trials have moved its model
    result.converged = better || ahead <= std::max(kLeastGain * now, std::pow(kSettled * noise_m_, 2));
    break;
  }
  return {};
}

/// Newton steps to the zero of the equations with derivatives at the shrunk postures. The gradient of
/// iterate() multiplies residuals by derivatives at postures that contain the noise of the same markers:
/// along directions that only motion determines it is a product of noise with noise. Derivatives at the
/// shrunk postures vanish there, and the priors decide. The shares of motion are then measured again, since
/// iterate() may have ended so far away that the variances of its postures are wrong.
Status Adaptation::settle(AdaptResult& result) {
  sums_ = projection_.solve(x_, states_);
  Quiet quiet;
  bool settled = true;
  for (int round = 0; round < kQuietRounds; ++round) {
    const VectorXd before = quiet.motion();
    quiet = Quiet::measure(projection_.problem(), projection_.layout(), markers_, states_, result.noise_sd_m,
                           options_.threads);
    if (round > 0 && (quiet.motion() - before).cwiseAbs().maxCoeff() < kSameMotion) break;
    settled = false;
    for (int i = 0; i < kSettleSteps && !settled; ++i) {
      if (progress_ && !progress_(result.iterations, result.iterations + kSettleSteps - i))
        return fail(Code::cancelled, "adapting the model was stopped");
      const auto left_sd = step_by(quiet);
      if (!left_sd) break;
      ++result.iterations;
      settled = *left_sd <= kSettled;
    }
  }
  of_motion_ = projection_.sums_at(states_, quiet.apply(projection_.problem(), states_));
  result.converged = result.converged && settled;
  return {};
}

/// One Newton step of settle(): its length in standard deviations, or nothing where there is no such step.
std::optional<double> Adaptation::step_by(const Quiet& quiet) {
  const NormalSums sums = projection_.sums_at(states_, quiet.apply(projection_.problem(), states_));
  const Known besides = known(x_);
  MatrixXd S = sums.S.selfadjointView<Eigen::Lower>();
  S += besides.S;
  VectorXd step = S.llt().solve(sums.g + besides.g);
  if (!step.allFinite()) return std::nullopt;
  for (Index k = 0; k < step.size(); ++k)
    step *= std::min(1.0, kFarthest * parameters_[at(k)].prior_sd / std::max(std::abs(step[k]), 1e-300));
  step *= share_of(step);
  const VectorXd x_try = x_ + step;
  MatrixXd states_try = states_;
  auto there = projection_.solve(x_try, states_try);
  if (!std::isfinite(there.cost)) return std::nullopt;
  x_ = x_try;
  states_ = std::move(states_try);
  sums_ = std::move(there);
  return std::sqrt(step.dot(S * step)) / noise_m_;
}

/// Covariance with and without the prior of the positions.
Status Adaptation::find_covariance(AdaptResult& result) {
  TissueModel tissue;
  std::optional<TissuePass> pass;
  const auto detect_tissue = [&] {
    const auto variances = estimate_variances(projection_.problem(), markers_, states_, options_.threads);
    pass.emplace(projection_.problem(), projection_.layout(), markers_, states_, options_.threads);
    tissue = pass->detect(variances);
  };
  if (options_.soft_tissue) detect_tissue();
  if (tissue.found) {
    // Correlated samples have less weight against the priors.
    noise_m_ = result.noise_sd_m * std::sqrt(tissue.inflation);
    if (auto s = iterate(options_.max_iterations, kNear, result); !s) return s;
    result.noise_sd_m = options_.marker_noise_sd_m > 0.0 ? options_.marker_noise_sd_m : residual_noise();
  }
  if (auto s = settle(result); !s) return s;
  if (tissue.found) detect_tissue();
  result.tissue_sd_m = tissue.found ? tissue.sd_m : 0.0;
  const double s2 = noise_m_ * noise_m_;
  const auto covariance = [&](double position_sd) {
    const MatrixXd besides = known(x_, position_sd).S;
    const MatrixXd inverse_S = inverse(of_motion_, besides);
    if (!tissue.found) return MatrixXd(s2 * inverse_S);
    MatrixXd middle = pass->middle(tissue, inverse_S);
    middle += s2 * besides;
    return MatrixXd(inverse_S * middle * inverse_S);
  };
  result.covariance = covariance(0.0);
  data_covariance_ = covariance(kNoPositionPrior_m);
  result.coordinate_sd = geometry_part(projection_.problem(), projection_.layout(), markers_, states_,
                                       result.covariance, options_.threads);
  if (!result.covariance.allFinite() || !data_covariance_.allFinite())
    return fail(Code::bad_input,
                "these data give no finite deviations of sizes; give more frames or markers");
  return {};
}

}  // namespace kinemark::motion::internal
