// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/propose_levels.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;

constexpr double kEvery_s = 0.5;
constexpr std::int64_t kMostPoses = 60;
constexpr double kIndependent = 0.1;  // kg^-1/2, smallest singular value in the worst pose
constexpr double kDecoupled = 0.9;    // cosine of the smallest angle of two row spaces, at most
constexpr double kSeen = 0.95;        // of the frames

/// Frames at which poses are looked at.
std::vector<std::int64_t> frames_looked_at(const Plan& plan) {
  const auto every = std::max<std::int64_t>(
      {1, std::llround(kEvery_s * plan.rate_hz), (plan.problem.frames + kMostPoses - 1) / kMostPoses});
  std::vector<std::int64_t> frames;
  for (std::int64_t f = 0; f < plan.problem.frames; f += every) frames.push_back(f);
  return frames;
}

/// The metric of the kinetic energy in a pose, without the speeds that are held.
class Metric {
 public:
  explicit Metric(const Plan& plan) : plan_(plan), w_(plan.problem.model) {}

  void set(const Eigen::VectorXd& x) {
    const auto& model = plan_.problem.model;
    model::kinematics(model, w_, x);
    model::velocities(model, w_, Eigen::VectorXd::Zero(model.speed_count()));
    model::mass_matrix(model, w_, mass_);
    hold_speeds(mass_, plan_.problem.fixed_speed);
    llt_.compute(mass_);
  }
  /// Columns: rows of a Jacobian in this metric.
  [[nodiscard]] MatrixXd of(const MatrixXd& jacobian) const {
    MatrixXd out = jacobian.transpose();
    for (Index k = 0; k < out.rows(); ++k)
      if (plan_.problem.fixed_speed[at(k)] != 0) out.row(k).setZero();
    llt_.matrixL().solveInPlace(out);
    return out;
  }
  [[nodiscard]] const model::Workspace& workspace() const { return w_; }

 private:
  const Plan& plan_;
  model::Workspace w_;
  MatrixXd mass_;
  Eigen::LLT<MatrixXd> llt_;
};

/// One pose: rows of all markers, and an orthonormal basis of those taken so far.
struct Pose {
  MatrixXd rows;   // n x 3 M
  MatrixXd basis;  // n x directions taken

  [[nodiscard]] MatrixXd left(const MatrixXd& columns) const {
    return basis.cols() == 0 ? columns : MatrixXd(columns - basis * (basis.transpose() * columns));
  }
  /// Add what is new in these columns; directions below `floor` are none.
  void take(const MatrixXd& columns, double floor) {
    if (columns.cols() == 0) return;
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(left(columns));
    const Index most = std::min(columns.cols(), columns.rows() - basis.cols());
    Index count = 0;
    while (count < most && std::abs(qr.matrixQR()(count, count)) > floor) ++count;
    if (count == 0) return;
    MatrixXd fresh = MatrixXd::Identity(columns.rows(), count);
    fresh.applyOnTheLeft(qr.householderQ());
    MatrixXd all(columns.rows(), basis.cols() + count);
    all << basis, fresh;
    basis = std::move(all);
  }
};

double smallest_singular(const MatrixXd& columns) {
  const Matrix3d squares = columns.transpose() * columns;
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix3d>(squares).eigenvalues()[0]));
}

MatrixXd orthonormal(const MatrixXd& columns) {
  MatrixXd q = MatrixXd::Identity(columns.rows(), columns.cols());
  q.applyOnTheLeft(Eigen::HouseholderQR<MatrixXd>(columns).householderQ());
  return q;
}

/// Cosine of the smallest angle between the rows of two markers, in the pose where it is largest.
double coupling(const std::vector<Pose>& poses, int a, int b) {
  double most = 0.0;
  for (const auto& pose : poses) {
    const Matrix3d cosines = orthonormal(pose.rows.middleCols(3 * Index{a}, 3)).transpose() *
                             orthonormal(pose.rows.middleCols(3 * Index{b}, 3));
    most = std::max(most, Eigen::JacobiSVD<Matrix3d>(cosines).singularValues()[0]);
  }
  return most;
}

/// Markers that may be chosen: seen nearly always.
std::vector<int> candidates(const Track& track) {
  std::vector<int> markers;
  for (Index m = 0; m < track.weights.rows(); ++m)
    if (static_cast<double>((track.weights.row(m).array() > 0.0).count()) >=
        kSeen * static_cast<double>(track.weights.cols()))
      markers.push_back(static_cast<int>(m));
  return markers;
}

/// The candidate with the largest smallest singular value in its worst pose, and that value.
std::pair<int, double> best_of(const std::vector<int>& markers, const std::vector<Pose>& poses) {
  std::pair<int, double> best{-1, -1.0};
  for (const int m : markers) {
    double worst = std::numeric_limits<double>::infinity();
    for (const auto& pose : poses) {
      worst = std::min(worst, smallest_singular(pose.left(pose.rows.middleCols(3 * Index{m}, 3))));
      if (worst <= best.second) break;
    }
    if (worst > best.second) best = {m, worst};
  }
  return best;
}

std::vector<Pose> poses_of(const Plan& plan, const Track& track) {
  Metric metric(plan);
  MatrixXd J;
  std::vector<Pose> poses;
  for (const auto f : frames_looked_at(plan)) {
    metric.set(track.states.col(f));
    model::marker_jacobian(plan.problem.model, metric.workspace(), J);
    auto rows = metric.of(J);
    poses.push_back({.rows = rows, .basis = MatrixXd(rows.rows(), 0)});
  }
  return poses;
}

}  // namespace

Result<LevelProposal> propose_levels(const Plan& plan, const Track& track) {
  const auto& described = plan.problem.model.description().markers;
  auto poses = poses_of(plan, track);
  auto left = candidates(track);
  LevelProposal proposal{.levels = {{}, {}}, .smallest = {{}, {}}, .poses = std::ssize(poses)};
  std::vector<int> first;
  double best = 0.0;
  while (!left.empty()) {
    const auto [marker, smallest] = best_of(left, poses);
    best = std::max(best, smallest);
    if (!(smallest >= kIndependent)) break;
    const bool is_decoupled = std::ranges::all_of(
        first, [&, m = marker](int other) { return coupling(poses, other, m) <= kDecoupled; });
    if (is_decoupled) first.push_back(marker);
    const std::size_t level = is_decoupled ? 0 : 1;
    proposal.levels[level].markers.push_back(described[at(marker)].name);
    proposal.smallest[level].push_back(smallest);
    for (auto& pose : poses) pose.take(pose.rows.middleCols(3 * Index{marker}, 3), 0.0);
    std::erase(left, marker);
  }
  if (first.empty())
    return fail(Code::bad_input,
                fmt::format("no levels can be proposed: no marker that is seen nearly always moves in three "
                            "directions of its own (at best {:.3g} kg^-1/2; {:g} is needed)",
                            best, kIndependent));
  if (proposal.levels[1].markers.empty()) {
    proposal.levels.pop_back();
    proposal.smallest.pop_back();
  }
  const auto chosen = first.size() + (proposal.levels.size() > 1 ? proposal.levels[1].markers.size() : 0);
  if (chosen < described.size()) proposal.levels.push_back({.markers = {"*"}});
  return proposal;
}

void count_directions(const Plan& plan, const Track& track, std::vector<LevelAccount>& levels) {
  if (levels.size() != plan.asked.size()) return;
  Metric metric(plan);
  GoalValues goal(plan.problem.model.marker_count());
  MatrixXd J;
  TaskRows rows;
  const auto held = std::ranges::count(plan.problem.fixed_speed, std::uint8_t{1});
  const int free = plan.problem.model.speed_count() - static_cast<int>(held);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i].rows = plan.asked[i].rows();
    levels[i].directions_left = free;
  }
  for (const auto f : frames_looked_at(plan)) {
    metric.set(track.states.col(f));
    model::marker_jacobian(plan.problem.model, metric.workspace(), J);
    goal.x = metric.workspace().marker;
    goal.weight = plan.problem.weight;
    Pose pose{.rows = {}, .basis = MatrixXd(J.cols(), 0)};
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const auto& level = plan.asked[i];
      levels[i].directions_left =
          std::min(levels[i].directions_left, free - static_cast<int>(pose.basis.cols()));
      MatrixXd all(level.rows(), J.cols());
      Index row = 0;
      for (const int m : level.markers) {
        all.middleRows<3>(row) = J.middleRows<3>(3 * Index{m});
        row += 3;
      }
      for (std::size_t t = 0; t < level.tasks.size(); ++t) {
        level.evaluate(t, plan.problem, metric.workspace(), goal, track.goals.time.time_s(f), rows);
        all.middleRows(row, rows.error.size()) = rows.jacobian;
        row += rows.error.size();
      }
      const auto columns = metric.of(all);
      pose.take(columns, std::max(1e-9, plan.damping.truncation * columns.colwise().norm().maxCoeff()));
    }
  }
}

}  // namespace kinemark::motion::internal
