// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_evidence.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/stages/skeleton/functional/internal/cluster.h"
#include "kinemark/stages/skeleton/functional/internal/gap_model.h"
#include "kinemark/stages/skeleton/functional/internal/posture.h"

namespace kinemark::skeleton {
namespace {

using Eigen::MatrixXd;

constexpr int kTerms = internal::kLinearTerms + internal::kQuadraticTerms;
constexpr double kRidge = 0.02;                ///< share of the variance from which a term counts
constexpr std::int64_t kLeastPartFrames = 11;  ///< of a movement
constexpr std::size_t kLeastMovements = 4;
constexpr double kSure = 0.01, kDoubtful = 0.1;  ///< p values
constexpr std::int64_t kEnough = 8;              ///< movements from which finding nothing says something
/// p is uniform where nothing slides; of slides of 1 mm, the least that matter, two in five lie below 0.01
/// (density k p^(k - 1)).
constexpr double kPower = 0.2;
constexpr double kNoneLikely = 0.5;  ///< probability of no own slide
constexpr double kGapShare = 0.1, kLeastGap_m = 1e-3;
constexpr double kRounding_m2 = 1e-14;

/// Sums of one movement's frames.
struct Sums {
  double n = 0.0;
  MatrixXd xx, xy;
  Eigen::VectorXd x;
  Eigen::RowVectorXd y;
};

Sums sums_of(const MatrixXd& X, const MatrixXd& Y) {
  return {.n = static_cast<double>(X.rows()),
          .xx = X.transpose() * X,
          .xy = X.transpose() * Y,
          .x = X.colwise().sum().transpose(),
          .y = Y.colwise().sum()};
}

/// Frames of each movement that is long enough: first, and one past the last.
std::vector<std::pair<Eigen::Index, Eigen::Index>> parts_of(const std::vector<int>& movement) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> out;
  std::size_t from = 0;
  for (std::size_t i = 1; i <= movement.size(); ++i) {
    if (i < movement.size() && movement[i] == movement[from]) continue;
    if (static_cast<std::int64_t>(i - from) >= kLeastPartFrames)
      out.emplace_back(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(i));
    from = i;
  }
  return out;
}

/// @param squares  of what was predicted, summed; may be null
Prediction predict(const MatrixXd& X, const MatrixXd& Y,
                   const std::vector<std::pair<Eigen::Index, Eigen::Index>>& parts, double* squares) {
  Prediction out;
  if (parts.size() < kLeastMovements || Y.cols() == 0) return out;
  std::vector<Sums> sums;
  Sums all = sums_of(X.topRows(0), Y.topRows(0));
  for (const auto& [from, to] : parts) {
    sums.push_back(sums_of(X.middleRows(from, to - from), Y.middleRows(from, to - from)));
    all.n += sums.back().n;
    all.xx += sums.back().xx;
    all.xy += sums.back().xy;
    all.x += sums.back().x;
    all.y += sums.back().y;
  }
  std::vector<double> share;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto [from, to] = parts[k];
    const double n = all.n - sums[k].n;
    MatrixXd normal = all.xx - sums[k].xx;
    normal.diagonal().array() += kRidge * n;
    const MatrixXd B =
        normal.llt().solve(all.xy - sums[k].xy - (all.x - sums[k].x) * ((all.y - sums[k].y) / n));
    MatrixXd y = Y.middleRows(from, to - from), p = X.middleRows(from, to - from) * B;
    y.rowwise() -= y.colwise().mean().eval();
    p.rowwise() -= p.colwise().mean().eval();
    const double variance = y.squaredNorm();
    share.push_back(variance > kRounding_m2 ? 1.0 - (y - p).squaredNorm() / variance : 0.0);
    if (squares != nullptr) *squares += p.squaredNorm();
  }
  const auto n = static_cast<double>(share.size());
  double mean = 0.0, variance = 0.0;
  for (const double s : share) mean += s / n;
  for (const double s : share) variance += (s - mean) * (s - mean) / (n - 1.0);
  const double t = mean / (std::sqrt(variance / n) + 1e-12);
  if (!std::isfinite(t)) return out;
  out.explained = mean;
  out.alike = std::ranges::count_if(share, [](double s) { return s > 0.0; });
  out.p_value = boost::math::cdf(boost::math::complement(boost::math::students_t(n - 1.0), t));
  return out;
}

MatrixXd scaled_terms(const internal::Posture& posture) {
  MatrixXd out = posture.terms.leftCols<kTerms>();
  for (int k = 0; k < kTerms; ++k)
    out.col(k) /= std::sqrt(out.col(k).squaredNorm() / static_cast<double>(out.rows())) + 1e-12;
  return out;
}

double mm(double m) { return 1e3 * m; }

}  // namespace

SkinEvidence find_skin(const Samples& samples, const SegmentPoses& parent, const SegmentPoses& child,
                       const RelativeMotion& motion, const JointFit& score) {
  SkinEvidence out;
  const auto clusters = internal::find_clusters(samples, parent, child, motion);
  const auto posture =
      internal::posture_of(parent, child, motion, clusters.frames, samples.trajectories.time.rate_hz);
  if (posture.frames.empty() || !posture.in_time) return out;
  const auto parts = parts_of(internal::movements_of(posture));
  out.movements = static_cast<std::int64_t>(parts.size());
  const MatrixXd X = scaled_terms(posture);
  const auto shape = [&](const SegmentPoses& poses, const internal::Cluster& cluster) {
    return predict(X, internal::deformation(samples, poses, cluster, posture.frames), parts, nullptr);
  };
  const Prediction above = shape(parent, clusters.parent), below = shape(child, clusters.child);
  out.shape = above.p_value < below.p_value ? above : below;
  if (!std::isnan(out.shape.p_value)) out.shape.p_value = std::min(1.0, 2.0 * out.shape.p_value);
  Eigen::MatrixX3d gap(X.rows(), 3);
  for (Eigen::Index i = 0; i < gap.rows(); ++i) {
    const auto f = posture.frames[at(i)];
    gap.row(i) = (parent.to_segment(f, child.to_world(f, score.centre.tail<3>())) - score.centre.head<3>())
                     .transpose();
  }
  double squares = 0.0;
  out.gap = predict(X, gap, parts, &squares);
  out.gap_rms_m = std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(gap.rows(), 1)));
  return out;
}

double calc_skin_probability(const SkinEvidence& evidence) {
  const double p = evidence.shape.p_value;
  if (std::isnan(p) || p < kSure || evidence.movements < kEnough) return 1.0;
  const double odds = kPower * std::pow(p, kPower - 1.0);
  return odds / (1.0 + odds);
}

data::SkinAccount account_of_skin(const SkinEvidence& evidence, const SkinSlide& slide) {
  data::SkinAccount out{.movements = evidence.movements,
                        .alike = evidence.shape.alike,
                        .p_value = evidence.shape.p_value,
                        .explained = evidence.shape.explained};
  if (!slide.known) return out;
  out.own_slide_m = std::max(slide.own_parent_m, slide.own_child_m);
  out.own_limit_m = slide.own_limit_m;
  const std::string count =
      fmt::format("{} movement{}", evidence.movements, evidence.movements == 1 ? "" : "s");
  if (evidence.shape.p_value < kSure) {
    out.verdict = data::SkinVerdict::follows;
    out.description = fmt::format(
        "The markers' shape follows the posture, the same in {} of {}: {:.0f} % of it (own slide about "
        "{:.1f} mm "
        "per rad). This moves the joint by about {:.1f} mm and is in the error bar.",
        evidence.shape.alike, count, 100.0 * evidence.shape.explained, mm(out.own_slide_m),
        mm(slide.moves_m));
  } else if (evidence.movements >= kEnough && evidence.shape.p_value > kDoubtful &&
             slide.none > kNoneLikely) {
    out.verdict = data::SkinVerdict::none_seen;
    out.description = fmt::format(
        "No sliding of markers with the posture is seen (less than {:.1f} mm per rad). The error bar assumes "
        "that "
        "what does not deform does not slide.",
        mm(std::max(out.own_limit_m, 0.1e-3)));
  } else {
    out.verdict = data::SkinVerdict::cannot_tell;
    out.description = fmt::format(
        "Whether the markers slide with the posture cannot be distinguished from {}; the error bar allows "
        "for up to "
        "{:.1f} "
        "mm per rad.",
        count, mm(std::max(out.own_limit_m, slide.common_m)));
  }
  const bool gap_alone = out.verdict != data::SkinVerdict::follows && evidence.shape.p_value > kDoubtful &&
                         evidence.gap.p_value < kSure && evidence.gap.explained > kGapShare &&
                         evidence.gap_rms_m > kLeastGap_m;
  if (gap_alone) {
    out.gap_m = evidence.gap_rms_m;
    out.description += fmt::format(
        " The two segments' common point moves by {:.1f} mm with the posture: the joint or the markers.",
        mm(out.gap_m));
  }
  return out;
}

}  // namespace kinemark::skeleton
