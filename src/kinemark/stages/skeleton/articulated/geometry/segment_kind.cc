// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/segment_kind.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/stages/skeleton/articulated/chain/small_cholesky.h"
#include "kinemark/stages/skeleton/articulated/geometry/frame_selection.h"
#include "kinemark/stages/skeleton/articulated/geometry/start_geometry.h"

namespace kinemark::skeleton::articulated {

namespace {

using data::SegmentKind;

constexpr double kNever = -std::numeric_limits<double>::infinity();  // a trial that was not made
constexpr double kPi = std::numbers::pi;
constexpr double kFirm = 50.0;  // information beyond which a rotation's integral is Gaussian
constexpr double kLineBonusOfFrame = 0.5;
constexpr double kLineBonus = 15.0;   // nats that another kind must be better than a line
constexpr double kPlaneBonus = 3.0;   // nats that a solid must be better than a plane
constexpr double kSurelyLine = 2.5;   // deviates of across_line()
constexpr double kSurelyWide = 60.0;  // and of across_plane()
constexpr std::size_t kFrames = 400, kLeastFrames = 150;
constexpr std::size_t kSegmentFrames = 2400;    // in all: of many segments fewer frames
constexpr int kFirstLook = 3, kSecondLook = 8;  // steps of a fit after which it may be given up
constexpr double kGainsLeft = 100.0;            // a fit gains no more than so many times its last step
constexpr int kFirstSteps = 6;                  // of a fit, until its noise is about known
constexpr double kLeastNats = 0.05;             // nats of a fit's last step

/// Modified Bessel function I_0 by its power series, all of whose terms are positive: h from 0 to kFirm.
/// (std::cyl_bessel_i is not in libc++.)
double bessel_i0(double h) {
  double term = 1.0, sum = 1.0;
  for (double k = 1.0; term > 1e-17 * sum; k += 1.0) {
    term *= 0.25 * h * h / (k * k);
    sum += term;
  }
  return sum;
}

/// What is tried, and on which frames.
struct Trial {
  const ChainSamples& samples;
  const ChainSamples& some;  ///< of them, enough for shapes to begin from
  const ChainLayout& layout;
  std::vector<std::int64_t> frames;
  double sigma_m = 0.0;  ///< 0: that which the first fit leaves
  int threads = 1;

  /// Log evidence of these kinds; where it cannot reach `needed`, what it is when that is seen. None where
  /// they cannot be fitted.
  [[nodiscard]] double evidence(const std::vector<SegmentKind>& kind, double needed);
};

double Trial::evidence(const std::vector<SegmentKind>& kind, double needed) {
  auto start = start_geometry(some, layout, kind, sigma_m);
  if (!start || !start->marker.allFinite()) start = start_geometry(samples, layout, kind, sigma_m);
  if (!start) return kNever;
  Chain chain = *start;
  const std::vector<double> weights(chain.markers(), 1.0);
  PosedFrames poses =
      first_poses(samples, chain, frames, weights, sigma_m > 0.0 ? sigma_m : 1e-3, 15, threads);
  if (poses.size() < 5) return kNever;
  GeometryFit fit(chain, samples, poses, 0.0, threads);
  const auto done = [&](int round, double gain_m2) {
    if (!(sigma_m > 0.0)) return false;
    const double gain = gain_m2 / (2.0 * sigma_m * sigma_m);
    if (gain < kLeastNats) return true;
    if (round != kFirstLook && round != kSecondLook) return false;
    const double reach = kGainsLeft * gain;
    return log_evidence(chain, samples, poses, sigma_m) + reach < needed;
  };
  const auto noise = [&](double cost) { return std::sqrt(cost / std::max(fit.degrees_of_freedom(), 1.0)); };
  const bool unknown = !(sigma_m > 0.0);
  if (unknown) sigma_m = noise(fit.run(kFirstSteps));
  const double cost = fit.run(20, {}, done);
  if (unknown) sigma_m = noise(cost);
  return sigma_m > 0.0 ? log_evidence(chain, samples, poses, sigma_m) : kNever;
}

}  // namespace

double log_evidence(const Chain& chain, const ChainSamples& samples, const PosedFrames& frames,
                    double sigma_m) {
  PoseSolver solver(chain);
  Eigen::MatrixXd H, firm;
  Eigen::VectorXd b;
  std::vector<Eigen::Index> rows;
  const double variance = sigma_m * sigma_m;
  double evidence = 0.0;
  double seen = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    solver.set(samples.frame(frames.frame[i]), frames.weight[i]);
    solver.normal(frames.pose[i], {}, false, H, b);
    seen += solver.sums().seen;
    evidence -= solver.cost(frames.pose[i]) / (2.0 * variance);
    H /= variance;
    firm = H;
    firm.diagonal().array() -= kFirm;
    if (cholesky_from_leaves(firm, rows) && cholesky_from_leaves(H, rows)) {  // all eigenvalues above kFirm
      evidence +=
          0.5 * static_cast<double>(H.rows()) * std::log(2.0 * kPi) - H.diagonal().array().log().sum();
    } else {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(H, Eigen::EigenvaluesOnly);
      for (const double value : eigen.eigenvalues()) {
        const double h = std::max(value, 1e-12);
        evidence +=
            h > kFirm ? 0.5 * std::log(2.0 * kPi / h) : std::log(2.0 * kPi * bessel_i0(h) * std::exp(-h));
      }
    }
    for (const SegmentKind kind : chain.kind) {
      evidence -= kind == SegmentKind::line ? std::log(4.0 * kPi) : std::log(8.0 * kPi * kPi);
    }
  }
  const double free =
      static_cast<double>(chain.geometry_parameters().size()) - static_cast<double>(chain.gauge().cols());
  return evidence - 0.5 * free * std::log(std::max(3.0 * seen, 1.0));
}

namespace {

// How far markers leave a line (2 dimensions) or a plane (1), as a standard normal deviate.
double off_shape(const ChainSamples& samples, std::span<const int> markers, double sigma_m, int dimensions) {
  const auto n = static_cast<double>(markers.size());
  const double free = dimensions * (n - 4.0 + dimensions);
  if (!(free > 0.0)) return 0.0;
  double squares = 0.0;
  double dof = 0.0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    if (!std::all_of(markers.begin(), markers.end(), [&](int k) { return samples.seen(f, k); })) continue;
    Vector3d mean = Vector3d::Zero();
    for (const int k : markers) mean += Eigen::Map<const Vector3d>(samples.frame(f) + 3 * k);
    mean /= n;
    Matrix3d scatter = Matrix3d::Zero();
    for (const int k : markers) {
      const Vector3d d = Eigen::Map<const Vector3d>(samples.frame(f) + 3 * k) - mean;
      scatter += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(scatter, Eigen::EigenvaluesOnly);
    for (int i = 0; i < dimensions; ++i) squares += std::max(eigen.eigenvalues()[i], 0.0);
    dof += free;
  }
  if (dof < 3.0 * free) return 0.0;
  return (squares / (sigma_m * sigma_m) - dof) / std::sqrt(2.0 * dof);
}

}  // namespace

double across_line(const ChainSamples& samples, std::span<const int> markers, double sigma_m) {
  return off_shape(samples, markers, sigma_m, 2);
}

double across_plane(const ChainSamples& samples, std::span<const int> markers, double sigma_m) {
  return off_shape(samples, markers, sigma_m, 1);
}

Result<std::vector<SegmentKind>> choose_kinds(const ChainSamples& samples, const ChainLayout& layout,
                                              double sigma_m, const std::function<bool()>& stopped,
                                              int threads) {
  // Kinds that a segment may have: what two markers and a joint show is never more than a plane.
  const int segments = layout.segments();
  std::vector<std::vector<SegmentKind>> allowed(segments);
  std::vector<SegmentKind> general(segments);
  for (int s = 0; s < segments; ++s) {
    const std::size_t n = layout.markers_of(s).size();
    const auto joints = std::count(layout.parent.begin(), layout.parent.end(), s) + (s > 0 ? 1 : 0);
    const std::size_t points = n + static_cast<std::size_t>(joints);
    general[s] = points >= 4 ? SegmentKind::solid : points == 3 ? SegmentKind::plane : SegmentKind::line;
    allowed[s].push_back(general[s]);
  }
  std::vector<std::int64_t> kept;
  const ChainSamples thinned = thin_out(samples, kFrames, kept);
  Trial trial{.samples = samples,
              .some = thinned,
              .layout = layout,
              .frames = {},
              .sigma_m = sigma_m,
              .threads = threads};
  auto& frames = trial.frames;
  {
    auto start = start_geometry(samples, layout, general, sigma_m);
    if (!start) {
      // Segments that carry too few markers for anything but a line are lines; where that is not enough, all.
      for (int s = 0; s < segments; ++s) {
        if (layout.markers_of(s).size() > 2) continue;
        general[s] = SegmentKind::line;
        allowed[s] = {SegmentKind::line};
      }
      const Error why = start.error();
      start = start_geometry(samples, layout, general, sigma_m);
      std::vector<SegmentKind> lines(segments, SegmentKind::line);
      if (!start && !start_geometry(samples, layout, lines, sigma_m)) return std::unexpected(why);
      if (!start) return lines;
    }
    frames = first_frames(samples, *start);
    std::vector<std::int64_t> some;
    const std::size_t most = std::clamp(kSegmentFrames / at(segments), kLeastFrames, kFrames);
    const std::size_t take = std::min(frames.size(), most);
    for (std::size_t i = 0; i < take; ++i) some.push_back(frames[i * frames.size() / take]);
    frames.swap(some);
  }
  if (frames.size() < 5) return general;
  const double of_general = trial.evidence(general, kNever);
  if (!(trial.sigma_m > 0.0)) return general;
  bool open = false;
  for (int s = 0; s < segments; ++s) {
    const std::vector<int> markers = layout.markers_of(s);
    const double across = across_line(samples, markers, trial.sigma_m);
    if (markers.size() >= 2 && general[s] != SegmentKind::line && across < kSurelyWide) {
      allowed[s].push_back(SegmentKind::line);
    }
    if (general[s] == SegmentKind::solid && across > kSurelyLine &&
        across_plane(samples, markers, trial.sigma_m) < kSurelyWide)
      allowed[s].push_back(SegmentKind::plane);
    open = open || allowed[s].size() > 1;
  }
  if (!open) return general;
  // All alike first, then segment by segment.
  const double line_bonus = std::max(kLineBonus, kLineBonusOfFrame * static_cast<double>(frames.size()));
  const auto bonus = [line_bonus](const std::vector<SegmentKind>& kind) {
    double sum = 0.0;
    for (const SegmentKind k : kind)
      sum += k == SegmentKind::line ? line_bonus : k == SegmentKind::plane ? kPlaneBonus : 0.0;
    return sum;
  };
  bool cancelled = false;
  std::vector<SegmentKind> best = general;
  double best_value = of_general + bonus(general);
  std::vector<std::pair<std::vector<SegmentKind>, double>> known{{general, best_value}};
  const auto value = [&](const std::vector<SegmentKind>& kind) {
    for (const auto& [tried, worth] : known) {
      if (tried == kind) return worth;
    }
    cancelled = cancelled || (stopped && stopped());
    const double more = bonus(kind);
    const double worth = cancelled ? kNever : trial.evidence(kind, best_value - more) + more;
    known.emplace_back(kind, worth);
    return worth;
  };
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane}) {
    std::vector<SegmentKind> alike = general;
    for (int s = 0; s < segments; ++s) {
      if (std::find(allowed[s].begin(), allowed[s].end(), kind) != allowed[s].end()) alike[s] = kind;
    }
    if (const double v = value(alike); v > best_value) {
      best_value = v;
      best = alike;
    }
  }
  for (int s = 0; s < segments; ++s) {
    for (const SegmentKind kind : allowed[s]) {
      std::vector<SegmentKind> other = best;
      other[s] = kind;
      if (const double v = value(other); v > best_value) {
        best_value = v;
        best = other;
      }
    }
  }
  if (cancelled) return fail(Code::cancelled, "stopped while choosing the kinds of segments");
  return best;
}

}  // namespace kinemark::skeleton::articulated
