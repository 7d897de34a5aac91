// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/slow_errors.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/smoother/internal/frame_rows.h"
#include "kinemark/stages/motion/smoother/internal/step_prior.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNode_s = 0.05;
constexpr std::int64_t kFramesOfNode = 2;  // frames used of each node, at most
// Nodes are solved in stretches, each with so many more on either side: 2 s, beyond which the smoother
// remembers nothing.
constexpr Index kStretch = 160, kBeside = 40;

/// What slides: single markers and whole segments, each along three axes.
struct Slides {
  std::vector<int> markers;  ///< with a slow part of their own
  std::vector<int> bodies;   ///< with a slow part that their markers share
  [[nodiscard]] Index columns() const { return 3 * static_cast<Index>(markers.size() + bodies.size()); }
};

Slides slides_of(const NoiseSplit& noise) {
  Slides slides;
  for (Index m = 0; m < noise.slow.size(); ++m)
    if (noise.slow[m] > 0.0) slides.markers.push_back(static_cast<int>(m));
  for (Index b = 0; b < noise.common_slow.size(); ++b)
    if (noise.common_slow[b] > 0.0) slides.bodies.push_back(static_cast<int>(b));
  return slides;
}

/// Normal equations of the nodes and the answers to the slides.
class Stretch {
 public:
  Stretch(const model::Model& model, const Observations& observations, const NoiseSplit& noise,
          const Slides& slides, const std::vector<std::uint8_t>& fixed, const MatrixXd& states,
          const MatrixXd& node_precision, std::int64_t frames_per_node)
      : model_(model),
        observations_(observations),
        noise_(noise),
        slides_(slides),
        fixed_(fixed),
        states_(states),
        per_node_(frames_per_node),
        rows_(model),
        prior_(model, node_precision),
        window_(model.speed_count()) {}

  /// Nodes [first, end) of all, of whose answers E x, squared and summed, the variances of [keep_first,
  /// keep_end) are written.
  void solve(Index first, Index end, Index keep_first, Index keep_end, const data::JointMotion& motion,
             MatrixXd& variance) {
    const Index n = model_.speed_count(), count = end - first;
    const double floor = 1.0 / (kFloorSd * kFloorSd * static_cast<double>(count));
    window_.clear();
    factors_.resize(at(count));
    answers_.assign(at(count + 3), MatrixXd::Zero(n, slides_.columns()));
    for (Index k = 0; k < count; ++k) {
      load_node(first + k, answers_[at(k)]);
      H_.diagonal().array() += floor;
      window_.add(0, H_, VectorXd::Zero(n));
      if (k + 3 < count) {
        (void)prior_.visit(state(first + k), state(first + k + 1), state(first + k + 2),
                           state(first + k + 3));
        prior_.add_to(window_);
      }
      window_.eliminate(fixed_.data(), factors_[at(k)]);
    }
    for (Index k = 0; k < count; ++k) {  // forward
      const auto& factor = factors_[at(k)];
      factor.L.triangularView<Eigen::Lower>().solveInPlace(answers_[at(k)]);
      for (Index a = 0; a < 3; ++a)
        answers_[at(k + 1 + a)].noalias() -= factor.Y.middleRows(a * n, n) * answers_[at(k)];
    }
    for (Index a = 0; a < 3; ++a) answers_[at(count + a)].setZero();
    for (Index k = count - 1; k >= 0; --k) {  // and back
      const auto& factor = factors_[at(k)];
      for (Index a = 0; a < 3; ++a)
        answers_[at(k)].noalias() -= factor.Y.middleRows(a * n, n).transpose() * answers_[at(k + 1 + a)];
      factor.L.transpose().triangularView<Eigen::Upper>().solveInPlace(answers_[at(k)]);
    }
    VectorXd q(motion.size());
    for (Index k = keep_first; k < keep_end; ++k) {
      const std::int64_t f = frame(k);
      std::copy_n(motion.q.data() + motion.index(f, 0), q.size(), q.data());
      auto& w = rows_.workspace();
      model::kinematics(model_, w, states_.col(f));
      model::coordinate_jacobian(model_, w, q, E_);
      variance.col(k) = (E_ * answers_[at(k - first)]).rowwise().squaredNorm();
    }
  }

 private:
  /// The frame in the middle of a node.
  [[nodiscard]] std::int64_t frame(Index node) const {
    return std::min<std::int64_t>(states_.cols() - 1, node * per_node_ + per_node_ / 2);
  }
  [[nodiscard]] VectorXd state(Index node) const { return states_.col(frame(node)); }

  /// Normal matrix of a node's frames, and J'W u for every slide u of one standard deviation.
  void load_node(Index node, MatrixXd& right) {
    const std::int64_t begin = node * per_node_,
                       end = std::min<std::int64_t>(states_.cols(), begin + per_node_);
    const std::int64_t stride = (end - begin + kFramesOfNode - 1) / kFramesOfNode;
    const std::int64_t used = (end - begin + stride - 1) / stride;
    const double share = static_cast<double>(end - begin) / static_cast<double>(used);
    MatrixXd own;
    H_.setZero(model_.speed_count(), model_.speed_count());
    for (std::int64_t f = begin; f < end; f += stride) {
      (void)rows_.visit(observations_, f, states_.col(f));
      rows_.matrix(own);
      H_ += share * own;
      add_slides(share, right);
    }
    for (Index i = 0; i < right.rows(); ++i)
      if (fixed_[at(i)]) right.row(i).setZero();
  }

  void add_slides(double share, MatrixXd& right) {
    Index column = 0;
    for (const int m : slides_.markers) {
      add_slide(m, share * std::sqrt(noise_.slow[m]), column, right);
      column += 3;
    }
    for (const int b : slides_.bodies) {
      for (int m = 0; m < model_.marker_count(); ++m)
        if (model_.markers()[at(m)].body == b)
          add_slide(m, share * std::sqrt(noise_.common_slow[b]), column, right);
      column += 3;
    }
  }

  void add_slide(int m, double size, Index column, MatrixXd& right) {
    const int body = model_.markers()[at(m)].body;
    auto& w = rows_.workspace();
    const double weight = size * rows_.information().weight[m];
    if (body < 0 || weight == 0.0) return;
    const Eigen::Vector3d p = w.marker.col(m);
    for (const int c : model_.bodies()[at(body)].support) {
      const auto& s = w.column[at(c)];
      right.row(model_.columns()[at(c)].speed).segment<3>(column) += weight * (s.v + s.w.cross(p));
    }
  }

  const model::Model& model_;
  const Observations& observations_;
  const NoiseSplit& noise_;
  const Slides& slides_;
  const std::vector<std::uint8_t>& fixed_;
  const MatrixXd& states_;
  std::int64_t per_node_;
  FrameRows rows_;
  StepPrior prior_;
  Window window_;
  MatrixXd H_, E_;
  std::vector<NodeFactor> factors_;
  std::vector<MatrixXd> answers_;  ///< nv x slides, per node
};

}  // namespace

SlowErrors::SlowErrors(const model::Model& model, const Observations& observations, const NoiseSplit& noise,
                       const std::vector<std::uint8_t>& fixed, const data::JointMotion& motion,
                       const MatrixXd& states, const MatrixXd& step_precision, int threads) {
  const std::int64_t F = motion.frames();
  frames_per_node_ = std::max<std::int64_t>(1, std::llround(kNode_s * motion.time.rate_hz));
  const Index nodes = (F + frames_per_node_ - 1) / frames_per_node_;
  variance_.setZero(model.coordinate_count(), nodes);
  const Slides slides = slides_of(noise);
  if (slides.columns() == 0) return;
  // The same density of the jerk, seen in wider steps.
  const MatrixXd node_precision = step_precision / std::pow(static_cast<double>(frames_per_node_), 5);
  const Index stretches = (nodes + kStretch - 1) / kStretch;
  parallel_for(stretches, 1, threads, [&](std::int64_t begin, std::int64_t end) {
    Stretch stretch(model, observations, noise, slides, fixed, states, node_precision, frames_per_node_);
    for (std::int64_t s = begin; s < end; ++s) {
      const Index first = s * kStretch, last = std::min(nodes, first + kStretch);
      stretch.solve(std::max<Index>(0, first - kBeside), std::min(nodes, last + kBeside), first, last, motion,
                    variance_);
    }
  });
}

double SlowErrors::variance(std::int64_t f, int c) const { return variance_(c, f / frames_per_node_); }

}  // namespace kinemark::motion::internal
