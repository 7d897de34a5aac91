// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/error_bars.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/math/nonnegative_least_squares.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/bar_limits.h"
#include "kinemark/stages/motion/internal/normal_inverse.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/internal/profile_errors.h"

namespace kinemark::motion {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using internal::kBlindFloor, internal::kBlindRotation, internal::kBlindTranslation, internal::kBarFloor;
using internal::kLargestSd, internal::kSampledFrames, internal::kVague;

constexpr double kLeastSd_m = 0.3e-3;  // of a marker
constexpr double kLeastKept = 1e-9;    // share of a marker's noise that its residual keeps
constexpr double kLeastSpread = 0.01;  // of the variances of markers, squared and relative

/// One thread's view of one frame: pose, visible markers, inverse normal matrices.
struct Frame {
  explicit Frame(const internal::Problem& p)
      : problem(p),
        w(p.model),
        y(3, p.model.marker_count()),
        weight(p.model.marker_count()),
        x(p.model.state_count()),
        q(p.model.coordinate_count()),
        inverse(p) {}

  void visit(const data::Trajectories& markers, const MatrixXd& states, std::int64_t f) {
    problem.observe(markers, f, y, weight);
    x = states.col(f);
    pose();
  }

  /// Everything that follows from x.
  void pose() {
    model::kinematics(problem.model, w, x);
    if (!problem.model.point_constraints().empty()) model::point_constraint_jacobian(problem.model, w, C);
  }

  /// Inverse of H on the speeds that may move and within the closed loops.
  void invert(MatrixXd& H, double floor, MatrixXd& K) { inverse.invert(H, C, floor, K); }

  /// K = (J'WJ + tasks)^-1; q must be set when there are tasks.
  void inverse_normal_matrix() {
    model::marker_normal_matrix(problem.model, w, weight, H);
    const double total = weight.sum();
    if (!problem.coordinate_tasks.empty()) {
      model::coordinate_jacobian(problem.model, w, q, E);
      for (const auto& task : problem.coordinate_tasks)
        H.noalias() += total * task.weight * E.row(task.coordinate).transpose() * E.row(task.coordinate);
    }
    invert(H, kBarFloor * total, K);
  }

  const internal::Problem& problem;
  model::Workspace w;
  Eigen::Matrix3Xd y;
  VectorXd weight, x, q;
  MatrixXd H, K, C, E, J;
  internal::NormalInverse inverse;
};

/// Sums of the normal equations for the variances.
struct Sums {
  MatrixXd N;
  VectorXd b, information, seen;
  double squares = 0.0, freedom = 0.0;
};

/// Add one frame's equations: for markers and for pairs of markers on one segment, expected against observed
/// products.
void add_equations(Frame& frame, const std::vector<int>& segment_of_body, const std::vector<int>& bodies,
                   Sums& sums) {
  const auto& model = frame.problem.model;
  std::vector<int> visible;
  for (int m = 0; m < model.marker_count(); ++m)
    if (frame.weight[m] > 0.0 && model.markers()[at(m)].body >= 0) visible.push_back(m);
  const auto V = static_cast<Eigen::Index>(visible.size());
  if (V == 0) return;
  model::marker_jacobian(model, frame.w, frame.J);
  MatrixXd J(3 * V, model.speed_count()), WJ;
  VectorXd r(3 * V);
  for (Eigen::Index i = 0; i < V; ++i) {
    const int m = visible[at(i)];
    J.middleRows<3>(3 * i) = frame.J.middleRows<3>(3 * m);
    r.segment<3>(3 * i) = frame.y.col(m) - frame.w.marker.col(m);
  }
  WJ = J;
  for (Eigen::Index i = 0; i < V; ++i) WJ.middleRows<3>(3 * i) *= frame.weight[visible[at(i)]];
  MatrixXd P = -J * (frame.K * WJ.transpose());
  P.diagonal().array() += 1.0;
  sums.squares += r.squaredNorm();
  sums.freedom += P.squaredNorm();

  const auto S = static_cast<Eigen::Index>(bodies.size());
  std::vector<MatrixXd> common(at(S), MatrixXd::Zero(3 * V, 3));
  std::vector<std::vector<Eigen::Index>> members(at(S));
  for (Eigen::Index i = 0; i < V; ++i) {
    const int s = segment_of_body[at(model.markers()[at(visible[at(i)])].body)];
    if (s < 0) continue;
    common[at(s)] += P.middleCols<3>(3 * i);
    members[at(s)].push_back(i);
  }
  const Eigen::Index M = model.marker_count(), unknowns = M + S;
  const auto add_row = [&](Eigen::Index i, Eigen::Index j, double count) {
    VectorXd row = VectorXd::Zero(unknowns);
    for (Eigen::Index k = 0; k < V; ++k)
      row[visible[at(k)]] = P.block<3, 3>(3 * i, 3 * k).cwiseProduct(P.block<3, 3>(3 * j, 3 * k)).sum();
    for (Eigen::Index s = 0; s < S; ++s)
      if (members[at(s)].size() > 1)
        row[M + s] =
            common[at(s)].middleRows<3>(3 * i).cwiseProduct(common[at(s)].middleRows<3>(3 * j)).sum();
    sums.N.selfadjointView<Eigen::Lower>().rankUpdate(row, count);
    sums.b += count * r.segment<3>(3 * i).dot(r.segment<3>(3 * j)) * row;
  };
  for (Eigen::Index i = 0; i < V; ++i) {
    add_row(i, i, 1.0);
    sums.information[visible[at(i)]] += P.block<3, 3>(3 * i, 3 * i).squaredNorm();
    sums.seen[visible[at(i)]] += 1.0;
  }
  for (const auto& member : members)
    for (std::size_t a = 0; a < member.size(); ++a)
      for (std::size_t b = a + 1; b < member.size(); ++b) add_row(member[a], member[b], 2.0);
}

}  // namespace

VectorXd information_of(const model::Model& model, const MarkerVariances& variances) {
  VectorXd information(model.marker_count());
  for (Eigen::Index m = 0; m < information.size(); ++m) {
    const int body = model.markers()[at(m)].body;
    const double v = variances.own[m] + (body >= 0 ? variances.common[body] : 0.0);
    information[m] = 1.0 / std::max(v, kLeastSd_m * kLeastSd_m);
  }
  return information;
}

/// How far the variances of single markers (M) lie from the pooled one, squared and relative to it; each
/// counts by `information` (M), its diagonal element of the normal equations.
double spread_of(const VectorXd& variances, const VectorXd& information, double pooled) {
  const double far = information.dot(((variances / pooled).array() - 1.0).square().matrix());
  return std::max(far / information.sum(), kLeastSpread);
}

struct VarianceSums::Impl {
  explicit Impl(const internal::Problem& problem)
      : frame(problem), segment_of_body(problem.model.bodies().size(), -1) {
    std::vector<int> on_body(segment_of_body.size(), 0);
    for (const auto& marker : problem.model.markers())
      if (marker.body >= 0) ++on_body[at(marker.body)];
    for (std::size_t b = 0; b < on_body.size(); ++b)
      if (on_body[b] > 1) {
        segment_of_body[b] = static_cast<int>(bodies.size());
        bodies.push_back(static_cast<int>(b));
      }
    const Eigen::Index M = problem.model.marker_count();
    const Eigen::Index unknowns = M + static_cast<Eigen::Index>(bodies.size());
    sums.N.setZero(unknowns, unknowns);
    sums.b.setZero(unknowns);
    sums.information.setZero(M);
    sums.seen.setZero(M);
  }

  /// The frame as `frame` holds it.
  void add() {
    if (frame.weight.sum() == 0.0) return;
    if (!frame.problem.coordinate_tasks.empty()) {
      frame.q.setZero();
      model::coordinates_from_state(frame.problem.model, frame.x, frame.q, frame.q);
    }
    frame.inverse_normal_matrix();
    add_equations(frame, segment_of_body, bodies, sums);
  }

  Frame frame;
  std::vector<int> segment_of_body, bodies;
  Sums sums;
};

VarianceSums::VarianceSums(const internal::Problem& problem) : impl_(std::make_unique<Impl>(problem)) {}
VarianceSums::VarianceSums(VarianceSums&&) noexcept = default;
VarianceSums& VarianceSums::operator=(VarianceSums&&) noexcept = default;
VarianceSums::~VarianceSums() = default;

void VarianceSums::add(const Eigen::Matrix3Xd& y, const VectorXd& weight, const VectorXd& state) {
  impl_->frame.y = y;
  impl_->frame.weight = weight;
  impl_->frame.x = state;
  impl_->frame.pose();
  impl_->add();
}

void VarianceSums::add(const VarianceSums& other) {
  Sums& total = impl_->sums;
  const Sums& more = other.impl_->sums;
  total.N += more.N;
  total.b += more.b;
  total.information += more.information;
  total.seen += more.seen;
  total.squares += more.squares;
  total.freedom += more.freedom;
}

MarkerVariances VarianceSums::variances() const {
  const Sums& total = impl_->sums;
  const auto& bodies = impl_->bodies;
  const Eigen::Index M = total.seen.size();
  MarkerVariances variances;
  const double pooled = total.freedom > 1e-6 ? total.squares / total.freedom : 0.0;
  variances.own.setConstant(M, pooled);
  variances.common.setZero(static_cast<Eigen::Index>(impl_->segment_of_body.size()));
  if (total.freedom < 5.0 * static_cast<double>(total.b.size()) || !(pooled > 0.0))
    return variances;  // too few data for variances of single markers, or none has an error
  MatrixXd N = total.N.selfadjointView<Eigen::Lower>();
  VectorXd b = total.b;
  const double spread =
      spread_of(math::nonnegative_least_squares(N, b).head(M), N.diagonal().head(M), pooled);
  for (Eigen::Index m = 0; m < M; ++m) {
    const double kept = total.seen[m] > 0.0 ? total.information[m] / total.seen[m] : 0.0;
    const double prior = std::max(2.0 * kept, kLeastKept) / spread;
    N(m, m) += prior;
    b[m] += prior * pooled;
  }
  const VectorXd v = math::nonnegative_least_squares(N, b);
  variances.own = v.head(M);
  for (std::size_t s = 0; s < bodies.size(); ++s)
    variances.common[bodies[s]] = v[M + static_cast<Eigen::Index>(s)];
  return variances;
}

MarkerVariances estimate_variances(const internal::Problem& problem, const data::Trajectories& markers,
                                   const MatrixXd& states, int threads) {
  const std::int64_t stride = (problem.frames + kSampledFrames - 1) / kSampledFrames;
  const std::int64_t sampled = (problem.frames + stride - 1) / stride, grain = 16;
  std::vector<VarianceSums> partial;
  for (std::int64_t begin = 0; begin < sampled; begin += grain) partial.emplace_back(problem);
  parallel_for(sampled, grain, threads, [&](std::int64_t begin, std::int64_t end) {
    Eigen::Matrix3Xd y(3, problem.model.marker_count());
    VectorXd weight(y.cols());
    for (std::int64_t i = begin; i < end; ++i) {
      problem.observe(markers, i * stride, y, weight);
      partial[at(begin / grain)].add(y, weight, states.col(i * stride));
    }
  });
  for (std::size_t i = 1; i < partial.size(); ++i) partial.front().add(partial[i]);
  return partial.front().variances();
}

void compute_error_bars(const internal::Problem& problem, const data::Trajectories& markers,
                        const MatrixXd& states, const MarkerVariances& variances, int threads,
                        data::JointMotion& motion) {
  const auto& model = problem.model;
  const int n = model.coordinate_count(), M = model.marker_count();
  motion.q_sd.assign(motion.q.size(), std::numeric_limits<double>::quiet_NaN());
  motion.determined.assign(motion.q.size(), 0);
  std::vector<std::uint8_t> open(motion.q.size(), 1);
  const VectorXd all = information_of(model, variances);
  parallel_for(problem.frames, 16, threads, [&](std::int64_t begin, std::int64_t end) {
    Frame frame(problem);
    internal::ProfileErrors profile(problem);
    MatrixXd unit_H, unit_K, B, rows, segment;
    VectorXd seen(M), spread(M), information(M), variance(n);
    for (std::int64_t f = begin; f < end; ++f) {
      frame.visit(markers, states, f);
      frame.q = Eigen::Map<const VectorXd>(motion.q.data() + motion.index(f, 0), n);
      model::coordinate_jacobian(model, frame.w, frame.q, frame.E);

      // The coordinates that these markers determine.
      for (int m = 0; m < M; ++m) seen[m] = frame.weight[m] > 0.0 ? 1.0 : 0.0;
      if (seen.sum() == 0.0) continue;
      model::marker_normal_matrix(model, frame.w, seen, unit_H);
      frame.invert(unit_H, kBlindFloor * seen.sum(), unit_K);
      rows.noalias() = frame.E * unit_K;
      std::uint8_t* determined = motion.determined.data() + motion.index(f, 0);
      for (int c = 0; c < n; ++c) {
        const double per_metre = std::sqrt(std::max(0.0, rows.row(c).dot(frame.E.row(c))));
        const bool rotation = motion.is_rotation[at(c)];
        determined[c] = per_metre <= (rotation ? kBlindRotation : kBlindTranslation);
        open[motion.index(f, c)] = determined[c] == 0 ? 1 : 0;
      }

      // Sandwich: K (J'W S W J) K.
      frame.inverse_normal_matrix();
      for (int m = 0; m < M; ++m) spread[m] = frame.weight[m] * frame.weight[m] * variances.own[m];
      model::marker_normal_matrix(model, frame.w, spread, B);
      for (Eigen::Index b = 0; b < variances.common.size(); ++b) {
        if (variances.common[b] == 0.0) continue;
        segment.setZero(3, model.speed_count());
        for (int m = 0; m < M; ++m) {
          if (model.markers()[at(m)].body != b || frame.weight[m] == 0.0) continue;
          for (const int column : model.bodies()[at(b)].support) {
            const auto& s = frame.w.column[at(column)];
            segment.col(model.columns()[at(column)].speed) +=
                frame.weight[m] * (s.v + s.w.cross(Eigen::Vector3d(frame.w.marker.col(m))));
          }
        }
        B.noalias() += variances.common[b] * segment.transpose() * segment;
      }
      rows.noalias() = frame.E * frame.K;
      bool lost = false, vague = false;
      for (int m = 0; m < M; ++m) {
        information[m] = frame.weight[m] > 0.0 ? all[m] : 0.0;
        lost = lost || information[m] != all[m];
      }
      for (int c = 0; c < n; ++c) {
        variance[c] = rows.row(c).dot(B * rows.row(c).transpose());
        vague = vague || !determined[c] || variance[c] > kVague * kVague;
      }
      if (lost && vague) profile.add(frame.x, frame.y, information, all, frame.E, variance);
      for (int c = 0; c < n; ++c) {
        if (!determined[c]) continue;
        const double sd = std::sqrt(std::max(0.0, variance[c]));
        if (sd <= kLargestSd)
          motion.q_sd[motion.index(f, c)] = sd;
        else
          determined[c] = 0;
      }
    }
  });
  motion.open_frames.assign(at(n), 0);
  for (std::size_t i = 0; i < open.size(); ++i) motion.open_frames[i % at(n)] += open[i];
}

namespace internal {

void widen(data::JointMotion& motion, std::size_t index, double variance) {
  constexpr double kBoundSds = 5.0;  // that bounds count, as those of direct control do
  const double before = motion.q_sd[index], sd = std::hypot(before, std::sqrt(variance));
  const bool sure = sd <= kLargestSd;
  motion.q_sd[index] = sure ? sd : kNaN;
  if (!motion.q_bound.empty())
    motion.q_bound[index] = sure ? motion.q_bound[index] + kBoundSds * (sd - before) : kNaN;
  if (!sure) motion.determined[index] = 0;
}

}  // namespace internal

}  // namespace kinemark::motion
